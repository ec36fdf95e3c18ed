#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/error.h"
#include "hal/outputs/display/card.h"
#include "hal/outputs/display/picture_area.h"
#include "hal/outputs/display/route.h"
#include "hal/outputs/display/shared_card.h"
#include "hal/surface.h"

namespace pleinair::hal::display {

/// A buffer of a mode's size, and the surface in it that pictures go to.
struct DisplayBuffer {
  enum class State { kFree, kLent, kQueued, kFlipping, kOnScreen };
  ScanOutBuffer memory;
  Surface surface;
  State state = State::kFree;
  bool isMapped = false;
  bool hasRemains = false;  ///< of a picture that lay elsewhere
};

/// The parts of a card that drive one display, claimed for an output (its connector, CRTC and
/// primary plane), the mode that they are set to, and the buffers that they scan out. One thread.
class DisplayPipe {
 public:
  /// One buffer is shown, one waits for its refresh, and one is filled.
  static constexpr std::size_t kBuffers = 3;

  /// `isModeChosen`: the mode was the program's choice, not the user's.
  DisplayPipe(ClaimedDisplay claimed, bool isModeChosen);
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
  /// Switches the display off (DPMS). 0, or −errno.
  int switchOff();
  /// Has the next refresh show a buffer; an event follows. 0, or −errno.
  int flipTo(const DisplayBuffer& buffer);
  /// Brings back what was shown before setMode().
  void restore();

  /// Empty before setMode(), which replaces them.
  std::vector<DisplayBuffer>& buffers() { return buffers_; }
  /// Lays the buffers' surfaces where pictures of this size go. Precondition: setMode().
  void place(FrameSize picture, const Placement& placement);

  /// What a call that answered −errno says to users. Marks the card as removed where it has gone.
  Error failure(int error, std::string problem) const;
  /// Why another is the card's master.
  std::string whoIsMaster() const;

 private:
  Result<void> makeBuffers();
  void destroyBuffers();
  int tryMode(const Mode& mode);
  Result<Mode> acceptedMode();

  std::shared_ptr<SharedCard> shared_;
  DisplayRoute route_;
  bool isModeChosen_ = false;
  Mode requested_;
  std::optional<SavedCrtc> saved_;  ///< what was shown before
  bool isSet_ = false;              ///< a mode was set
  ObjectId modeBlob_ = 0;
  ObjectId flipProperty_ = 0;  ///< the plane's FB_ID
  PictureArea area_;
  std::vector<DisplayBuffer> buffers_;
};

}  // namespace pleinair::hal::display
