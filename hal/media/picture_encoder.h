#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/error.h"
#include "hal/image.h"

namespace pleinair::hal {

/// The kinds of picture files that are written.
enum class PictureFileKind { kPng, kJpeg, kTiff };

/// By the ending, in either case: .png, .jpg, .jpeg, .tif, .tiff. Nothing for others.
std::optional<PictureFileKind> writtenPictureKind(const std::filesystem::path& path);
/// ".png, .jpg, .jpeg, .tif or .tiff", for messages.
const std::string& writtenPictureEndings();

/// libjpeg's scale, 1 … 100: more is better and larger. 92 shows no loss to the eye.
inline constexpr double kDefaultJpegQuality = 92;

struct PictureFileOptions {
  std::optional<double> quality = std::nullopt;  ///< of JPEG; unset: kDefaultJpegQuality
  /// Pixels an inch, which is what printing programs size pictures by; unset: none is written.
  std::optional<double> dotsPerInch = std::nullopt;
};

/// Encodes pictures of one format as whole files in memory, tagged as sRGB: JPEG and TIFF carry an
/// ICC profile, PNG its chunk sRGB. The same picture gives the same bytes. One thread.
class PictureEncoder {
 public:
  virtual ~PictureEncoder() = default;
  /// Precondition: `picture` is complete and has the encoder's format.
  virtual Result<std::vector<std::uint8_t>> encode(const ImageView& picture) = 0;
};

/// For RGB8. PNG is written for speed, TIFF with LZW, JPEG without chroma subsampling from quality
/// 90 up. Errors: kUnsupported (format).
Result<std::unique_ptr<PictureEncoder>> openPictureEncoder(PictureFileKind kind, FrameFormat format,
                                                           const PictureFileOptions& options = {});

}  // namespace pleinair::hal
