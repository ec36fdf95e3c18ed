#include "hal/cameras/aravis/arv_handles.h"

#include <utility>

namespace pleinair::hal::aravis {
namespace {

ErrorKind kindOf(const GError& error) {
  if (error.domain != ARV_DEVICE_ERROR) return ErrorKind::kIo;
  switch (error.code) {
    case ARV_DEVICE_ERROR_NOT_FOUND:
      return ErrorKind::kNotFound;
    case ARV_DEVICE_ERROR_NOT_CONTROLLER:
    case ARV_DEVICE_ERROR_PROTOCOL_ERROR_ACCESS_DENIED:
    case ARV_DEVICE_ERROR_PROTOCOL_ERROR_BUSY:
      return ErrorKind::kBusy;
    case ARV_DEVICE_ERROR_NOT_CONNECTED:
    case ARV_DEVICE_ERROR_TIMEOUT:
      return ErrorKind::kDeviceLost;
    case ARV_DEVICE_ERROR_FEATURE_NOT_FOUND:
    case ARV_DEVICE_ERROR_WRONG_FEATURE:
    case ARV_DEVICE_ERROR_GENICAM_NOT_FOUND:
    case ARV_DEVICE_ERROR_NO_STREAM_CHANNEL:
      return ErrorKind::kUnsupported;
    default:
      return ErrorKind::kIo;
  }
}

}  // namespace

Error GlibError::as(std::string problem) const {
  Error error{.kind = ErrorKind::kIo, .problem = std::move(problem)};
  if (error_ == nullptr) return error;
  error.kind = kindOf(*error_);
  error.problem += std::string(": ") + error_->message;
  if (error.kind == ErrorKind::kBusy) {
    error.remedy = "end the program that controls the camera";
  } else if (error.kind == ErrorKind::kDeviceLost) {
    error.remedy = "check its cable and its power";
  }
  return error;
}

std::string textOf(const char* text) {
  return text == nullptr ? std::string() : std::string(text);
}

}  // namespace pleinair::hal::aravis
