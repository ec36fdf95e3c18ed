#include "pipeline/engine/camera_path.h"

namespace pleinair {

std::string_view toString(LumaSource source) {
  switch (source) {
    case LumaSource::kNone:
      return "none";
    case LumaSource::kInPlace:
      return "in place";
    case LumaSource::kSecondStream:
      return "second stream";
    case LumaSource::kReadback:
      return "read back";
    case LumaSource::kCopy:
      return "copy";
  }
  return "unknown";
}

}  // namespace pleinair
