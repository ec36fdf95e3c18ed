#include "hal/media/picture_encoder.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "hal/media/jpeg_encoder.h"
#include "hal/media/png_file.h"
#include "hal/media/tiff_encoder.h"

namespace pleinair::hal {
namespace {

struct PictureEnding {
  std::string_view text;
  PictureFileKind kind;
};
constexpr std::array<PictureEnding, 5> kWrittenEndings{{{".png", PictureFileKind::kPng},
                                                        {".jpg", PictureFileKind::kJpeg},
                                                        {".jpeg", PictureFileKind::kJpeg},
                                                        {".tif", PictureFileKind::kTiff},
                                                        {".tiff", PictureFileKind::kTiff}}};

class PngPictures final : public PictureEncoder {
 public:
  explicit PngPictures(const PictureFileOptions& options)
      : tags_{.isSrgb = true, .dotsPerInch = options.dotsPerInch} {}

  Result<std::vector<std::uint8_t>> encode(const ImageView& picture) override {
    return encodePng(picture, tags_);
  }

 private:
  PngTags tags_;
};

}  // namespace

std::optional<PictureFileKind> writtenPictureKind(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  const auto found = std::ranges::find(kWrittenEndings, ending, &PictureEnding::text);
  if (found == kWrittenEndings.end()) return std::nullopt;
  return found->kind;
}

const std::string& writtenPictureEndings() {
  static const std::string kText = ".png, .jpg, .jpeg, .tif or .tiff";
  return kText;
}

Result<std::unique_ptr<PictureEncoder>> openPictureEncoder(PictureFileKind kind, FrameFormat format,
                                                           const PictureFileOptions& options) {
  if (format.pixelFormat != PixelFormat::kRgb8) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = "picture",
                                .problem = "cannot be written unless it is RGB"});
  }
  if (kind == PictureFileKind::kJpeg) return makeJpegEncoder(format, options);
  if (kind == PictureFileKind::kTiff) return makeTiffEncoder(format, options);
  return std::make_unique<PngPictures>(options);
}

}  // namespace pleinair::hal
