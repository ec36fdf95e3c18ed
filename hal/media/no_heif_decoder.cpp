// A build without libheif refuses HEIC and AVIF, and says which package is missing.
#include "hal/media/heif_decoder.h"

namespace pleinair::hal::libav {

Result<std::shared_ptr<const AVFrame>> decodeHeif(std::span<const std::uint8_t>,
                                                  const std::string& subject) {
  return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                              .subject = subject,
                              .problem = "is a HEIC or AVIF picture, and this build has no libheif",
                              .remedy = "convert it to PNG, or build with libheif-dev"});
}

}  // namespace pleinair::hal::libav
