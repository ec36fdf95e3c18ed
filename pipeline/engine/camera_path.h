#pragma once

#include <string>
#include <string_view>

#include "pipeline/gpu/frames/camera_frames.h"

namespace pleinair {

/// The longer side, in px, of the images that motion is followed in: what a camera may make beside
/// larger frames (hal::StreamRequest::lumaSidePx).
inline constexpr int kTrackedSidePx = 640;

/// Where trackers have the luma of a frame from.
enum class LumaSource {
  kNone,          ///< nothing tracks
  kInPlace,       ///< the frame's own memory
  kSecondStream,  ///< a small image that the camera makes beside the frame
  kReadback,      ///< the GPU's copy of it, behind a fence
  kCopy,  ///< the processor's copy of it, since memory that a device shares may be slow to read
};
std::string_view toString(LumaSource source);

/// How the frames of the camera reach the GPU and the trackers.
struct CameraPath {
  gpu::FramePathStatus frames;
  LumaSource luma = LumaSource::kNone;
  std::string lumaReason;  ///< why from there; empty: no frame yet
};

}  // namespace pleinair
