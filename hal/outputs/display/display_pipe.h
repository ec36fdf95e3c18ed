#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/error.h"
#include "hal/outputs/display/card.h"
#include "hal/outputs/display/drift.h"
#include "hal/outputs/display/picture_area.h"
#include "hal/outputs/display/route.h"
#include "hal/outputs/display/shared_card.h"
#include "hal/surface.h"

namespace pleinair::hal::display {

/// A buffer of the canvas's size, and the surface in it that pictures go to. The processor writes
/// it, or a GPU draws into it.
struct DisplayBuffer {
  enum class State { kFree, kLent, kQueued, kFlipping, kOnScreen };
  ScanOutBuffer memory;
  std::optional<GpuBuffer> gpu;  ///< in place of `memory`
  Surface surface;
  State state = State::kFree;
  bool isMapped = false;
  bool hasRemains = false;  ///< of a picture that lay elsewhere
  bool isRetired = false;   ///< others have taken its place: it goes once it is free

  ObjectId framebuffer() const { return gpu ? gpu->framebuffer : memory.framebuffer; }
};

/// The parts of a card that drive one display, claimed for an output (its connector, CRTC and
/// primary plane), the mode that they are set to, and the buffers that they scan out. One thread.
class DisplayPipe {
 public:
  /// One buffer is shown, one waits for its refresh, and one is filled.
  static constexpr std::size_t kBuffers = 3;

  /// `isModeChosen`: the mode was the program's choice, not the user's. `drift`: by how many pixels
  /// the canvas reaches beyond the display on each side, for panTo().
  DisplayPipe(ClaimedDisplay claimed, bool isModeChosen, int drift);
  /// Brings back what was shown before, unless restore() did, and lets go of the card's parts.
  ~DisplayPipe();
  DisplayPipe(const DisplayPipe&) = delete;
  DisplayPipe& operator=(const DisplayPipe&) = delete;

  SharedCard& shared() { return *shared_; }
  Card& card() const { return shared_->card(); }
  const Connector& connector() const { return route_.connector; }
  ObjectId crtc() const { return route_.crtc.id; }
  const Mode& mode() const { return route_.mode; }
  /// The mode that was asked for last; the card may have refused it (setMode()).
  const Mode& requestedMode() const { return requested_; }

  /// Becomes the card's master and sets a mode, with the first of new buffers, black, on the
  /// screen. If the card refuses a mode that the program chose, the largest that it takes. Errors:
  /// kBusy (another program or console), kDeviceLost, kUnsupported (the mode is refused), kIo.
  Result<void> setMode(const Mode& mode);
  /// Sets the mode in force anew, with the picture in `shown`. 0, or −errno.
  int setModeAgain(const DisplayBuffer& shown);
  /// Has the display show the part of its canvas at a step of driftAt(), from the next flip on. A
  /// card that refuses that stays where it is.
  void panTo(std::uint64_t step);
  /// The size of its buffers: the mode's, and the drift on each side.
  FrameSize canvasSize() const;
  /// Switches the display off (DPMS). 0, or −errno.
  int switchOff();
  /// Has the next refresh show a buffer; with a sync_file, which waitsForFences() is needed for,
  /// the next one after that has signalled. −1: none. An event follows. 0, or −errno.
  int flipTo(const DisplayBuffer& buffer, int syncFile);
  /// Whether the card itself waits for fences (IN_FENCE_FD).
  bool waitsForFences() const { return fenceProperty_ != 0; }
  /// Brings back what was shown before setMode().
  void restore();

  /// Empty before setMode(), which replaces them.
  std::vector<DisplayBuffer>& buffers() { return buffers_; }

  /// Makes buffers of the canvas's size that a GPU draws into, in one of these layouts that the
  /// plane takes too; the card has agreed to flip to them. Those before are retired. Precondition:
  /// setMode(). Errors: kUnsupported, kNoSpace, kDeviceLost; there are none then.
  Result<void> makeGpuBuffers(std::span<const std::uint64_t> modifiers, std::size_t count);
  /// Those that are in use stay until destroyRetired() finds them free.
  void retireGpuBuffers();
  void destroyRetired();
  /// Also the retired ones; their addresses last.
  const std::vector<std::unique_ptr<DisplayBuffer>>& gpuBuffers() const { return gpuBuffers_; }
  /// Where the picture lies in one of them.
  GpuSurface gpuSurface(const DisplayBuffer& buffer) const;

  /// Lays the buffers' surfaces where pictures of this size go. Precondition: setMode().
  void place(FrameSize picture, const Placement& placement);

  /// What a call that answered −errno says to users. Marks the card as removed where it has gone.
  Error failure(int error, std::string problem) const;
  /// Why another is the card's master.
  std::string whoIsMaster() const;

 private:
  Result<void> makeBuffers();
  void destroyBuffers();
  int tryToFlip(const DisplayBuffer& buffer);
  int flip(const DisplayBuffer& buffer, int syncFile, bool pans);
  Error noGpuBuffers(int error, std::string problem) const;
  int tryMode(const Mode& mode);
  Result<Mode> acceptedMode();

  std::shared_ptr<SharedCard> shared_;
  DisplayRoute route_;
  bool isModeChosen_ = false;
  Mode requested_;
  std::optional<SavedCrtc> saved_;  ///< what was shown before
  bool isSet_ = false;              ///< a mode was set
  ObjectId modeBlob_ = 0;
  ObjectId flipProperty_ = 0;   ///< the plane's FB_ID
  ObjectId fenceProperty_ = 0;  ///< its IN_FENCE_FD; 0: it has none
  ObjectId sourceX_ = 0;        ///< its SRC_X
  ObjectId sourceY_ = 0;        ///< its SRC_Y
  int drift_ = 0;
  CanvasOffset wantedOffset_;
  CanvasOffset offset_;  ///< in force
  PictureArea area_;
  std::vector<DisplayBuffer> buffers_;
  std::vector<std::unique_ptr<DisplayBuffer>> gpuBuffers_;
  std::uint32_t lastGpuId_ = kBuffers;
};

}  // namespace pleinair::hal::display
