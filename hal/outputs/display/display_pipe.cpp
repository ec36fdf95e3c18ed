#include "hal/outputs/display/display_pipe.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdint>
#include <utility>

#include "hal/outputs/display/display_errors.h"
#include "hal/outputs/display/modeset.h"

namespace pleinair::hal::display {
namespace {

constexpr std::size_t kPixelBytes = 4;

}  // namespace

DisplayPipe::DisplayPipe(ClaimedDisplay claimed, bool isModeChosen)
    : shared_(std::move(claimed.card)),
      route_(std::move(claimed.route)),
      isModeChosen_(isModeChosen) {
  const Property* framebuffer = find(route_.plane.properties, "FB_ID");
  flipProperty_ = framebuffer == nullptr ? 0 : framebuffer->id;
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
}

Result<void> DisplayPipe::makeBuffers() {
  for (std::size_t i = 0; i < kBuffers; ++i) {
    DisplayBuffer buffer;
    const int failed = card().createBuffer(route_.mode.size, buffer.memory);
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
  return shared_->commit(modesetChanges(route_, modeBlob_, buffers_.front().memory.framebuffer),
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
  return shared_->commit(modesetChanges(route_, modeBlob_, shown.memory.framebuffer),
                         Commit::kModeset);
}

int DisplayPipe::switchOff() {
  return shared_->commit(switchOffChanges(route_), Commit::kModeset);
}

int DisplayPipe::flipTo(const DisplayBuffer& buffer) {
  const Change change{route_.plane.id, flipProperty_, buffer.memory.framebuffer};
  return shared_->commit({&change, 1}, Commit::kFlip);
}

void DisplayPipe::restore() {
  if (isSet_ && saved_) card().restore(*std::exchange(saved_, std::nullopt));
}

void DisplayPipe::place(FrameSize picture, const Placement& placement) {
  assert(!buffers_.empty());
  const PictureArea before = area_;
  area_ = areaOf(picture, route_.mode.size, placement);
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
