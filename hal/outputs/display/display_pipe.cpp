#include "hal/outputs/display/display_pipe.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <utility>

#include "hal/outputs/display/display_errors.h"
#include "hal/outputs/display/modeset.h"

namespace pleinair::hal::display {
namespace {

constexpr std::size_t kPixelBytes = 4;

ObjectId idOf(const Plane& plane, std::string_view name) {
  const Property* property = find(plane.properties, name);
  return property == nullptr ? 0 : property->id;
}

}  // namespace

DisplayPipe::DisplayPipe(ClaimedDisplay claimed, bool isModeChosen, int drift)
    : shared_(std::move(claimed.card)),
      route_(std::move(claimed.route)),
      isModeChosen_(isModeChosen),
      flipProperty_(idOf(route_.plane, "FB_ID")),
      fenceProperty_(idOf(route_.plane, "IN_FENCE_FD")),
      sourceX_(idOf(route_.plane, "SRC_X")),
      sourceY_(idOf(route_.plane, "SRC_Y")),
      drift_(drift),
      wantedOffset_(driftAt(0, drift)),
      offset_(wantedOffset_) {}

FrameSize DisplayPipe::canvasSize() const {
  return {route_.mode.size.width + 2 * drift_, route_.mode.size.height + 2 * drift_};
}

void DisplayPipe::panTo(std::uint64_t step) {
  wantedOffset_ = driftAt(step, drift_);
}

DisplayPipe::~DisplayPipe() {
  restore();
  destroyBuffers();
  if (modeBlob_ != 0) card().destroyBlob(modeBlob_);
  shared_->release(route_);
}

void DisplayPipe::destroyBuffers() {
  for (const DisplayBuffer& each : buffers_) {
    assert(!each.isMapped);
    card().destroyBuffer(each.memory);
  }
  buffers_.clear();
  for (const auto& each : gpuBuffers_) card().destroyGpuBuffer(*each->gpu);
  gpuBuffers_.clear();
}

Result<void> DisplayPipe::makeBuffers() {
  for (std::size_t i = 0; i < kBuffers; ++i) {
    DisplayBuffer buffer;
    const int failed = card().createBuffer(canvasSize(), buffer.memory);
    if (failed != 0) {
      return tl::unexpected(errnoError(route_.connector.name,
                                       "has no memory for a picture of its size", -failed,
                                       "use a smaller mode"));
    }
    buffer.surface.id = SurfaceId{static_cast<std::uint32_t>(i)};
    buffer.surface.fourcc = kXrgb8888;
    buffers_.push_back(buffer);
  }
  return {};
}

/// Makes buffers of the mode's size and asks whether the card would show them. 0, or −errno.
int DisplayPipe::tryMode(const Mode& mode) {
  route_.mode = mode;
  destroyBuffers();
  if (modeBlob_ != 0) card().destroyBlob(std::exchange(modeBlob_, 0));
  if (const int failed = card().createBlob(mode.timings, modeBlob_); failed != 0) return failed;
  if (!makeBuffers()) return -ENOMEM;
  return shared_->commit(
      modesetChanges(route_, modeBlob_, buffers_.front().memory.framebuffer, offset_),
      Commit::kTest);
}

/// The requested mode; where that was the program's choice and the card refuses it, the largest one
/// that it takes.
Result<Mode> DisplayPipe::acceptedMode() {
  int failed = tryMode(requested_);
  if (failed == 0) return requested_;
  if (isModeChosen_ && (failed == -EINVAL || failed == -ENOMEM || failed == -ENOSPC)) {
    std::vector<Mode> others = route_.connector.modes;
    std::ranges::stable_sort(others, std::greater<>(),
                             [](const Mode& m) { return m.size.pixels(); });
    for (const Mode& each : others) {
      if (each.timings == requested_.timings || each.isInterlaced) continue;
      failed = tryMode(each);
      if (failed == 0) return each;
    }
  }
  return tl::unexpected(failure(failed, "refuses the mode " + requested_.name));
}

Result<void> DisplayPipe::setMode(const Mode& mode) {
  if (shared_->takeMaster() != 0) return tl::unexpected(failure(-EACCES, "cannot be had"));
  if (!isSet_) saved_ = card().saveCrtc(route_.crtc.id);
  requested_ = mode;
  const Result<Mode> accepted = acceptedMode();
  if (!accepted) return tl::unexpected(accepted.error());
  const int failed = setModeAgain(buffers_.front());
  if (failed != 0) return tl::unexpected(failure(failed, "cannot set the mode " + accepted->name));
  isSet_ = true;
  return {};
}

int DisplayPipe::setModeAgain(const DisplayBuffer& shown) {
  return shared_->commit(modesetChanges(route_, modeBlob_, shown.framebuffer(), offset_),
                         Commit::kModeset);
}

int DisplayPipe::switchOff() {
  return shared_->commit(switchOffChanges(route_), Commit::kModeset);
}

int DisplayPipe::flipTo(const DisplayBuffer& buffer, int syncFile) {
  if (wantedOffset_ == offset_) return flip(buffer, syncFile, false);
  const int failed = flip(buffer, syncFile, true);
  if (failed == -EINVAL || failed == -ERANGE) {
    wantedOffset_ = offset_;
    return flip(buffer, syncFile, false);
  }
  if (failed == 0) offset_ = wantedOffset_;
  return failed;
}

/// Changes nothing but what has to be: some drivers set a mode anew for a property of the same
/// value.
int DisplayPipe::flip(const DisplayBuffer& buffer, int syncFile, bool pans) {
  assert(syncFile < 0 || waitsForFences());
  std::array<Change, 4> changes{Change{route_.plane.id, flipProperty_, buffer.framebuffer()}};
  std::size_t count = 1;
  const auto add = [&](ObjectId property, std::uint64_t value) {
    changes.at(count++) = {route_.plane.id, property, value};
  };
  if (syncFile >= 0) add(fenceProperty_, static_cast<std::uint64_t>(syncFile));
  if (pans && wantedOffset_.x != offset_.x) add(sourceX_, sourcePlace(wantedOffset_.x));
  if (pans && wantedOffset_.y != offset_.y) add(sourceY_, sourcePlace(wantedOffset_.y));
  return shared_->commit(std::span(changes).first(count), Commit::kFlip);
}

int DisplayPipe::tryToFlip(const DisplayBuffer& buffer) {
  const Change change{route_.plane.id, flipProperty_, buffer.framebuffer()};
  return shared_->commit({&change, 1}, Commit::kTestFlip);
}

Error DisplayPipe::noGpuBuffers(int error, std::string problem) const {
  if (error == -ENODEV || error == -ENXIO || error == -EIO || error == -EACCES) {
    return failure(error, std::move(problem));
  }
  Error refused = errnoError(route_.connector.name, std::move(problem), -error);
  refused.kind =
      error == -ENOMEM || error == -ENOSPC ? ErrorKind::kNoSpace : ErrorKind::kUnsupported;
  return refused;
}

Result<void> DisplayPipe::makeGpuBuffers(std::span<const std::uint64_t> modifiers,
                                         std::size_t count) {
  assert(!buffers_.empty());
  retireGpuBuffers();
  std::vector<std::uint64_t> plane = route_.plane.modifiers;
  if (plane.empty()) plane.push_back(kLinearModifier);
  std::vector<std::uint64_t> common;
  std::ranges::copy_if(modifiers, std::back_inserter(common), [&](std::uint64_t each) {
    return std::ranges::find(plane, each) != plane.end();
  });
  if (common.empty()) {
    return tl::unexpected(noGpuBuffers(-ENOTSUP, "takes none of the layouts that the GPU draws"));
  }
  for (std::size_t i = 0; i < count; ++i) {
    auto buffer = std::make_unique<DisplayBuffer>();
    GpuBuffer made;
    if (const int failed = card().createGpuBuffer(canvasSize(), common, made); failed != 0) {
      retireGpuBuffers();
      return tl::unexpected(noGpuBuffers(
          failed, i == 0 ? "cannot make a buffer for the GPU" : "has no memory for more buffers"));
    }
    buffer->gpu = made;
    buffer->surface.id = SurfaceId{lastGpuId_++};
    buffer->surface.fourcc = kXrgb8888;
    buffer->surface.modifier = made.modifier;
    buffer->surface.planeCount = made.planeCount;
    buffer->surface.planes = made.planes;
    gpuBuffers_.push_back(std::move(buffer));
  }
  if (const int refused = tryToFlip(*gpuBuffers_.back()); refused != 0) {
    retireGpuBuffers();
    return tl::unexpected(noGpuBuffers(refused, "refuses to show what the GPU draws into"));
  }
  return {};
}

void DisplayPipe::retireGpuBuffers() {
  for (const auto& each : gpuBuffers_) {
    each->isRetired = true;
    // One that is lent does not come back: what is drawn into it lives as long as it is imported.
    if (each->state == DisplayBuffer::State::kLent) each->state = DisplayBuffer::State::kFree;
  }
  destroyRetired();
}

void DisplayPipe::destroyRetired() {
  std::erase_if(gpuBuffers_, [this](const std::unique_ptr<DisplayBuffer>& each) {
    if (!each->isRetired || each->state != DisplayBuffer::State::kFree) return false;
    card().destroyGpuBuffer(*each->gpu);
    return true;
  });
}

GpuSurface DisplayPipe::gpuSurface(const DisplayBuffer& buffer) const {
  GpuSurface surface{
      .surface = buffer.surface, .bufferSize = canvasSize(), .x = area_.x, .y = area_.y};
  surface.surface.format = {.pixelFormat = PixelFormat::kRgba8, .size = area_.size, .encoding = {}};
  return surface;
}

void DisplayPipe::restore() {
  if (isSet_ && saved_) card().restore(*std::exchange(saved_, std::nullopt));
}

void DisplayPipe::place(FrameSize picture, const Placement& placement) {
  assert(!buffers_.empty());
  const PictureArea before = area_;
  area_ = areaOf(picture, canvasSize(), placement);
  for (DisplayBuffer& each : buffers_) {
    if (before != PictureArea() && before != area_) each.hasRemains = true;
    const std::size_t offset = static_cast<std::size_t>(area_.y) * each.memory.strideBytes +
                               static_cast<std::size_t>(area_.x) * kPixelBytes;
    each.surface.format = {.pixelFormat = PixelFormat::kRgba8, .size = area_.size, .encoding = {}};
    each.surface.planes[0] = {.dmaBuf = each.memory.dmaBuf,
                              .offsetBytes = offset,
                              .strideBytes = each.memory.strideBytes};
  }
}

std::string DisplayPipe::whoIsMaster() const {
  return areCardsYielded() ? kOtherConsole : notMaster(card().node(), {}).problem;
}

Error DisplayPipe::failure(int error, std::string problem) const {
  const std::string& place = route_.connector.name;
  if (error == -EACCES || error == -EPERM) {
    if (areCardsYielded()) {
      return {.kind = ErrorKind::kBusy,
              .subject = place,
              .problem = kOtherConsole,
              .remedy = "go back to pleinair's: Ctrl+Alt+F1 … F12, or chvt"};
    }
    return notMaster(card().node(), place);
  }
  if (error == -ENODEV || error == -ENXIO || error == -EIO) {
    shared_->markRemoved();
    return {.kind = ErrorKind::kDeviceLost,
            .subject = card().node(),
            .problem = "the graphics card is gone",
            .remedy = {},
            .domain = ErrorDomain::kErrno,
            .code = -error};
  }
  Error other = errnoError(place, std::move(problem), -error);
  if (error == -EINVAL) other.kind = ErrorKind::kUnsupported;
  return other;
}

}  // namespace pleinair::hal::display
