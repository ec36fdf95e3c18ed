#include "pipeline/gpu/frames/camera_frames.h"

#include <algorithm>
#include <cassert>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "pipeline/gpu/frames/frame_planes.h"
#include "pipeline/gpu/frames/imported_texture.h"
#include "pipeline/gpu/images/pixel_comparison.h"

namespace pleinair::gpu {
namespace {

/// A camera that has more buffers than this gets only these imported.
constexpr std::size_t kMostBuffers = 64;

/// In the first plane: from a sample to the next of the same kind.
std::size_t bytesFromLumaToLuma(hal::PixelFormat format) {
  switch (format) {
    case hal::PixelFormat::kYuyv:
      return 2;
    case hal::PixelFormat::kRgb8:
      return 3;
    case hal::PixelFormat::kRgba8:
      return 4;
    default:
      return 1;
  }
}

/// Whether the planes' pixels tell a right picture from a blank or a shifted one: a lens cap, or
/// the black of a camera that starts, does not.
bool isTelling(const hal::ImageView& image) {
  constexpr int kLeastSpread = 16;
  constexpr int kRows = 16;
  int least = 255;
  int most = 0;
  const int height = image.format.size.height;
  const std::size_t step = bytesFromLumaToLuma(image.format.pixelFormat);
  for (int i = 0; i < std::min(kRows, height); ++i) {
    const auto row = image.row(0, height * i / std::min(kRows, height));
    for (std::size_t x = 0; x < row.size(); x += step) {
      least = std::min(least, int{row[x]});
      most = std::max(most, int{row[x]});
    }
  }
  return most - least >= kLeastSpread;
}

bool areAllShared(const hal::CapturedFrame& frame) {
  for (int i = 0; i < planeCount(frame.image.format.pixelFormat); ++i) {
    if (frame.dmaBufs.at(static_cast<std::size_t>(i)).fd < 0) return false;
  }
  return true;
}

}  // namespace

std::string_view toString(FramePath path) {
  switch (path) {
    case FramePath::kUploaded:
      return "uploaded";
    case FramePath::kTrying:
      return "trying";
    case FramePath::kImported:
      return "imported";
  }
  return "unknown";
}

CameraFrames::CameraFrames(const ShaderLibrary& library, const ContextInfo& context,
                           const GpuTestHook& testHook, const hal::Clock& clock)
    : uploader_(library), context_(context), testHook_(testHook), clock_(clock) {
  readings_.reserve(kMostHeld);
}

/// The GPU may read buffers that their drivers would write to.
CameraFrames::~CameraFrames() {
  if (ContextLossGuard::isInForce()) return;
  for (const Reading& each : readings_) static_cast<void>(each.fence.wait(testHook_));
}

const Texture& CameraFrames::show(const hal::CapturedFrame& frame, hal::FrameSize size,
                                  const AspectFill& fit) {
  releaseRead();
  shown_.reset();
  const bool isNew =
      frame.buffer.pool != pool_ || frame.image.format != format_ || frame.modifier != modifier_;
  // A copy that a camera makes while all its buffers are leased is no new memory.
  const bool isCopy = !frame.buffer && frame.image.format == format_ && pool_ != 0;
  if (isNew && !isCopy) beginMemory(frame);
  const bool hasComeRound =
      frame.buffer.index < buffers_.size() && buffers_[frame.buffer.index].isKnown;
  const bool isImported = !isCopy && frame.buffer && frame.buffer.index < kMostBuffers &&
                          status_.path != FramePath::kUploaded && followTrial(frame) &&
                          readings_.size() < kMostHeld;
  if (!isImported) return upload(frame, size, fit);
  try {
    if (hasComeRound && !isConfirmed_) {
      if (!compare(frame)) return upload(frame, size, fit);
      isConfirmed_ = true;
    }
    const Texture& shown = uploader_.show(frame.image.format, imported(frame).planes, size, fit);
    hold(frame);
    shown_ = frame.buffer.index;
    ++status_.imported;
    return shown;
  } catch (const hal::Failure& failure) {
    refuse(failure.error().problem);
    return upload(frame, size, fit);
  }
}

const Texture& CameraFrames::upload(const hal::CapturedFrame& frame, hal::FrameSize size,
                                    const AspectFill& fit) {
  const std::uint64_t before = uploader_.uploadedBytes();
  const hal::FrameMapping mapped = frame.image.map();
  const Texture& shown = uploader_.upload(mapped.view(), size, fit);
  ++status_.uploaded;
  status_.uploadedBytes += uploader_.uploadedBytes() - before;
  return shown;
}

/// Forgets what was imported, and looks whether the new memory can be tried.
void CameraFrames::beginMemory(const hal::CapturedFrame& frame) {
  pool_ = frame.buffer.pool;
  format_ = frame.image.format;
  modifier_ = frame.modifier;
  began_ = clock_.now();
  buffers_.clear();
  isConfirmed_ = false;
  std::string problem = problemOf(frame);
  if (problem.empty()) {
    decide(FramePath::kTrying, "a trial of importing the camera's memory runs");
  } else {
    decide(FramePath::kUploaded, std::move(problem));
  }
}

/// Why the memory cannot be imported; empty: it may be.
std::string CameraFrames::problemOf(const hal::CapturedFrame& frame) const {
  if (!frame.buffer || !areAllShared(frame)) {
    return "the camera's frames lie in no memory that it shares (dma-buf)";
  }
  for (int plane = 0; plane < planeCount(format_.pixelFormat); ++plane) {
    const PlaneTexture wanted = importedPlane(format_, plane);
    if (std::max(wanted.size.width, wanted.size.height) > context_.maxSidePixels) {
      return fmt::format("a plane of {}x{} exceeds the GPU's limit of {} px a side",
                         wanted.size.width, wanted.size.height, context_.maxSidePixels);
    }
    std::string problem = planeImportProblem(wanted.fourcc, frame.modifier, testHook_);
    if (!problem.empty()) return problem;
  }
  // It gains nothing, and drivers of this kind have crashed in memory that they imported without an
  // error (Mesa 22.3: what vivid exports, through vgem).
  if (context_.isSoftware && !testHook_.importPlane) {
    return "a software renderer reads the camera's memory as it is";
  }
  return {};
}

/// Goes on with the trial. Whether the frame is to be imported.
bool CameraFrames::followTrial(const hal::CapturedFrame& frame) {
  if (status_.path == FramePath::kImported) return true;
  if (!isTelling(frame.image.map().view())) return false;
  try {
    if (!compare(frame)) return false;
  } catch (const hal::Failure& failure) {
    refuse(failure.error().problem);
    return false;
  }
  decide(FramePath::kImported, "planes of the camera's memory, compared with the processor's view");
  return true;
}

/// The images of the frame's buffer. Throws hal::Failure.
CameraFrames::ImportedBuffer& CameraFrames::imported(const hal::CapturedFrame& frame) {
  if (frame.buffer.index >= buffers_.size()) buffers_.resize(frame.buffer.index + 1);
  ImportedBuffer& buffer = buffers_[frame.buffer.index];
  if (buffer.isKnown) return buffer;
  for (int plane = 0; plane < planeCount(format_.pixelFormat); ++plane) {
    const auto at = static_cast<std::size_t>(plane);
    buffer.planes.at(at) = importedPlaneTexture(frame.dmaBufs.at(at), importedPlane(format_, plane),
                                                frame.modifier, frame.buffer.index, testHook_);
  }
  buffer.isKnown = true;
  return buffer;
}

/// Whether the GPU reads what the processor does; refuses the memory if not. Waits for the GPU.
/// Throws hal::Failure.
bool CameraFrames::compare(const hal::CapturedFrame& frame) {
  const hal::FrameSize size = frame.image.format.size;
  const AspectFill fit = aspectFill(size, size);
  uploader_.show(frame.image.format, imported(frame).planes, size, fit);
  const std::vector<std::uint8_t> seen = pixelsOf(uploader_.native());
  {
    const hal::FrameMapping mapped = frame.image.map();
    uploader_.upload(mapped.view(), size, fit);
  }
  const std::vector<std::uint8_t> right = pixelsOf(uploader_.native());
  if (seen == right) return true;
  refuse(differenceText(seen, right));
  return false;
}

/// Keeps the buffer from its driver until the GPU has read it.
void CameraFrames::hold(const hal::CapturedFrame& frame) {
  if (testHook_.returnsFramesEarly) return;
  readings_.push_back({.lease = frame.lease, .fence = Fence::insert()});
  status_.heldLeases = readings_.size();
}

std::span<const Texture> CameraFrames::importedPlanes() const {
  if (!shown_) return {};
  return std::span(buffers_[*shown_].planes)
      .first(static_cast<std::size_t>(planeCount(format_.pixelFormat)));
}

void CameraFrames::holdLonger() {
  if (shown_ && !readings_.empty()) readings_.back().fence = Fence::insert();
}

void CameraFrames::releaseRead() {
  const auto isRead = [this](const Reading& each) {
    const hal::Answer passed = each.fence.passed(testHook_);
    return passed.hasError() || passed.isYes();  // a lost GPU reads nothing
  };
  const auto firstUnread = std::ranges::find_if_not(readings_, isRead);
  readings_.erase(readings_.begin(), firstUnread);
  status_.heldLeases = readings_.size();
}

void CameraFrames::decide(FramePath path, std::string reason) {
  status_.path = path;
  status_.reason = std::move(reason);
  status_.trial = clock_.now() - began_;
}

void CameraFrames::refuse(std::string reason) {
  buffers_.clear();
  decide(FramePath::kUploaded, std::move(reason));
}

}  // namespace pleinair::gpu
