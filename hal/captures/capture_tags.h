#pragma once

namespace pleinair::hal::captures {

// Names of the Matroska tags of a captured stream.

inline constexpr const char* kLayoutTag = "PLEINAIR_LAYOUT";    ///< "nv12": the camera's layout
inline constexpr const char* kPeriodTag = "PLEINAIR_PERIOD";    ///< ns; absent if unknown
inline constexpr const char* kCameraTag = "PLEINAIR_CAMERA";    ///< "v4l2:ID (HD Webcam)"
inline constexpr const char* kRequestTag = "PLEINAIR_REQUEST";  ///< what the camera was asked for

}  // namespace pleinair::hal::captures
