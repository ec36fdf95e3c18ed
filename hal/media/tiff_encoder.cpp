#include "hal/media/tiff_encoder.h"

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <cstring>

#include <tiffio.h>

#include "hal/media/srgb_profile.h"

namespace pleinair::hal {
namespace {

/// A file in memory for libtiff.
struct TiffBytes {
  std::vector<std::uint8_t> bytes;
  std::size_t position = 0;

  static tmsize_t read(thandle_t handle, void* to, tmsize_t size) {
    auto& file = *static_cast<TiffBytes*>(handle);
    const std::size_t there = file.bytes.size() - std::min(file.position, file.bytes.size());
    const std::size_t count = std::min(there, static_cast<std::size_t>(size));
    std::memcpy(to, file.bytes.data() + file.position, count);
    file.position += count;
    return static_cast<tmsize_t>(count);
  }
  static tmsize_t write(thandle_t handle, void* from, tmsize_t size) {
    auto& file = *static_cast<TiffBytes*>(handle);
    const auto count = static_cast<std::size_t>(size);
    file.bytes.resize(std::max(file.bytes.size(), file.position + count));
    std::memcpy(file.bytes.data() + file.position, from, count);
    file.position += count;
    return size;
  }
  static toff_t seek(thandle_t handle, toff_t offset, int whence) {
    auto& file = *static_cast<TiffBytes*>(handle);
    const std::size_t from = whence == SEEK_CUR   ? file.position
                             : whence == SEEK_END ? file.bytes.size()
                                                  : 0;
    file.position = from + static_cast<std::size_t>(offset);
    return file.position;
  }
  static int close(thandle_t) { return 0; }
  static toff_t size(thandle_t handle) { return static_cast<TiffBytes*>(handle)->bytes.size(); }
};

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using TiffHandle = std::unique_ptr<TIFF, CloseTiff>;

class TiffEncoder final : public PictureEncoder {
 public:
  TiffEncoder(FrameFormat format, const PictureFileOptions& options)
      : format_(format), options_(options) {}

  Result<std::vector<std::uint8_t>> encode(const ImageView& picture) override {
    assert(picture.format == format_ && picture.isComplete());
    TiffBytes file;
    TiffHandle tiff(TIFFClientOpen("TIFF", "w", &file, TiffBytes::read, TiffBytes::write,
                                   TiffBytes::seek, TiffBytes::close, TiffBytes::size, nullptr,
                                   nullptr));
    if (tiff == nullptr || !writeTo(*tiff, picture)) return tl::unexpected(failed());
    if (TIFFFlush(tiff.get()) != 1) return tl::unexpected(failed());
    tiff.reset();
    return std::move(file.bytes);
  }

 private:
  bool writeTo(TIFF& tiff, const ImageView& picture) const {
    const std::vector<std::uint8_t>& profile = srgbProfile();
    bool isSet = TIFFSetField(&tiff, TIFFTAG_IMAGEWIDTH, format_.size.width) == 1;
    isSet = isSet && TIFFSetField(&tiff, TIFFTAG_IMAGELENGTH, format_.size.height) == 1;
    isSet = isSet && TIFFSetField(&tiff, TIFFTAG_SAMPLESPERPIXEL, 3) == 1;
    isSet = isSet && TIFFSetField(&tiff, TIFFTAG_BITSPERSAMPLE, 8) == 1;
    isSet = isSet && TIFFSetField(&tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB) == 1;
    isSet = isSet && TIFFSetField(&tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == 1;
    isSet = isSet && TIFFSetField(&tiff, TIFFTAG_COMPRESSION, COMPRESSION_LZW) == 1;
    isSet = isSet && TIFFSetField(&tiff, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL) == 1;
    isSet = isSet && TIFFSetField(&tiff, TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(&tiff, 0)) == 1;
    isSet = isSet && TIFFSetField(&tiff, TIFFTAG_ICCPROFILE, static_cast<int>(profile.size()),
                                  profile.data()) == 1;
    if (options_.dotsPerInch) {
      isSet = isSet && TIFFSetField(&tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH) == 1;
      isSet = isSet && TIFFSetField(&tiff, TIFFTAG_XRESOLUTION, *options_.dotsPerInch) == 1;
      isSet = isSet && TIFFSetField(&tiff, TIFFTAG_YRESOLUTION, *options_.dotsPerInch) == 1;
    }
    std::vector<std::uint8_t> samples;  // which the predictor changes
    for (int y = 0; isSet && y < format_.size.height; ++y) {
      const auto row = picture.row(0, y);
      samples.assign(row.begin(), row.end());
      isSet = TIFFWriteScanline(&tiff, samples.data(), static_cast<std::uint32_t>(y), 0) == 1;
    }
    return isSet;
  }

  static Error failed() {
    return {.kind = ErrorKind::kInternal, .subject = "TIFF", .problem = "cannot encode"};
  }

  FrameFormat format_;
  PictureFileOptions options_;
};

}  // namespace

std::unique_ptr<PictureEncoder> makeTiffEncoder(FrameFormat format,
                                                const PictureFileOptions& options) {
  return std::make_unique<TiffEncoder>(format, options);
}

}  // namespace pleinair::hal
