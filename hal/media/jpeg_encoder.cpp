#include "hal/media/jpeg_encoder.h"

#include <array>
#include <cassert>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <jpeglib.h>

#include "hal/media/srgb_profile.h"

namespace pleinair::hal {
namespace {

/// libjpeg's errors come back by longjmp, past frames without destructors only.
struct JpegErrors {
  jpeg_error_mgr manager{};
  std::jmp_buf back{};
  std::array<char, JMSG_LENGTH_MAX> message{};
};

void onJpegError(j_common_ptr info) {
  auto* const errors = reinterpret_cast<JpegErrors*>(info->err);
  info->err->format_message(info, errors->message.data());
  std::longjmp(errors->back, 1);
}

void onJpegMessage(j_common_ptr) {}

/// What encode() does between setjmp() and longjmp(): no object in it has a destructor.
struct JpegJob {
  const ImageView* picture = nullptr;
  int quality = 0;
  bool isSubsampled = false;
  int dotsPerInch = 0;  ///< 0: unknown
  const std::uint8_t* profile = nullptr;
  unsigned profileBytes = 0;
  unsigned char* out = nullptr;  ///< malloc's
  unsigned long outBytes = 0;
};

bool runJpegJob(JpegJob& job, JpegErrors& errors) {
  jpeg_compress_struct info{};
  info.err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = onJpegError;
  errors.manager.output_message = onJpegMessage;
  if (setjmp(errors.back) != 0) {
    jpeg_destroy_compress(&info);
    return false;
  }
  jpeg_create_compress(&info);
  jpeg_mem_dest(&info, &job.out, &job.outBytes);
  info.image_width = static_cast<JDIMENSION>(job.picture->format.size.width);
  info.image_height = static_cast<JDIMENSION>(job.picture->format.size.height);
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, job.quality, TRUE);
  info.optimize_coding = TRUE;
  info.dct_method = JDCT_ISLOW;
  if (!job.isSubsampled) {
    info.comp_info[0].h_samp_factor = 1;
    info.comp_info[0].v_samp_factor = 1;
  }
  if (job.dotsPerInch > 0) {
    info.density_unit = 1;
    info.X_density = static_cast<UINT16>(job.dotsPerInch);
    info.Y_density = info.X_density;
  }
  jpeg_start_compress(&info, TRUE);
  jpeg_write_icc_profile(&info, job.profile, job.profileBytes);
  while (info.next_scanline < info.image_height) {
    const auto row = job.picture->row(0, static_cast<int>(info.next_scanline));
    JSAMPROW samples = const_cast<JSAMPROW>(row.data());  // which it only reads
    jpeg_write_scanlines(&info, &samples, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  return true;
}

class JpegEncoder final : public PictureEncoder {
 public:
  JpegEncoder(FrameFormat format, const PictureFileOptions& options)
      : format_(format), options_(options) {}

  Result<std::vector<std::uint8_t>> encode(const ImageView& picture) override {
    assert(picture.format == format_ && picture.isComplete());
    constexpr double kWholeChroma = 90;
    const std::vector<std::uint8_t>& profile = srgbProfile();
    const double quality = options_.quality.value_or(kDefaultJpegQuality);
    JpegJob job{.picture = &picture,
                .quality = static_cast<int>(std::lround(quality)),
                .isSubsampled = quality < kWholeChroma,
                .dotsPerInch = static_cast<int>(std::lround(options_.dotsPerInch.value_or(0))),
                .profile = profile.data(),
                .profileBytes = static_cast<unsigned>(profile.size())};
    JpegErrors errors;
    const bool isDone = runJpegJob(job, errors);
    std::vector<std::uint8_t> bytes;
    if (isDone) bytes.assign(job.out, job.out + job.outBytes);
    std::free(job.out);
    if (isDone) return bytes;
    return tl::unexpected(Error{.kind = ErrorKind::kInternal,
                                .subject = "JPEG",
                                .problem = std::string("cannot encode: ") + errors.message.data()});
  }

 private:
  FrameFormat format_;
  PictureFileOptions options_;
};

}  // namespace

std::unique_ptr<PictureEncoder> makeJpegEncoder(FrameFormat format,
                                                const PictureFileOptions& options) {
  return std::make_unique<JpegEncoder>(format, options);
}

}  // namespace pleinair::hal
