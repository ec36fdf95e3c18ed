#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "hal/clock.h"
#include "hal/output.h"
#include "hal/output_kind.h"
#include "hal/outputs/display/blanking.h"
#include "hal/outputs/display/card.h"
#include "hal/outputs/display/dimming.h"
#include "hal/outputs/display/picture_area.h"

namespace pleinair::hal {

struct DisplaySettings {
  std::string mode = "auto";  ///< display::DisplayRequest::mode
  display::Placement placement;
  display::BlankingRules blanking;
  display::DimmingRules dimming = {};
  /// By how many pixels, at most, pictures move away from the middle and back, a pixel in each
  /// kDriftInterval, so that nothing burns in; as much of each edge is cut off. 0: not at all.
  int driftPixels = 0;
  static constexpr Duration kDriftInterval = std::chrono::minutes(1);
  bool lendsToGpu = true;  ///< else pictures are always copied
};

/// A display without a desktop, through the kernel's mode setting (DRM/KMS), by atomic commits.
/// `name`: "display", the first that is plugged in; "display:HDMI-A-1", by its connector;
/// "display:card1-HDMI-A-1", where two cards have connectors of one name. Opens nothing yet.
/// `cards` and `clock`, which is CLOCK_MONOTONIC but for tests, outlive it.
///
/// start() sets the mode, black, and answers the part of the display that pictures cover, and its
/// refresh. A driver without vertical blanking (virtual cards) counts none: surfaces are then shown
/// at the mode's rate by the clock, and their events have no sequence. Errors also: kDeviceLost
/// (nothing is plugged in), kBusy (another program or output shows on it), kUnsupported (the card
/// refuses the mode).
///
/// Surfaces are buffers that the processor writes; beside them, where the card has such, buffers
/// that a GPU draws into. Whether the display is still plugged in is looked at once a second; it is
/// lost then, and where a flip does not take place within a second.
///
/// While another console is in front (leaveConsole()) or another program has become the card's
/// master, it is suspended, and afterwards sets its mode anew, as it does after the computer was
/// suspended. While it is blanked, it is suspended with the display switched off; noteActivity(),
/// which counts for all displays of `cards`, switches it on. While it is dimmed, brightness() says
/// so; its own backlight is left alone.
///
/// finish() and destruction bring back what was shown before; where the process is killed, the
/// kernel brings back its console.
///
/// Errors: kInvalidArgument (no such name).
Result<std::unique_ptr<SurfaceOutput>> openDisplay(const std::string& name,
                                                   const DisplaySettings& settings = {},
                                                   display::Cards& cards = display::kernelCards(),
                                                   const Clock& clock = steadyClock());

/// For hal::VirtualTerminal: lets go of all displays of the process, which show what they showed
/// before, and has them go on. Any thread.
void leaveConsole();
void enterConsole();

/// The connectors of all cards, with the sizes of the displays in them, from the kernel's list
/// (`folder`, as /sys/class/drm). Opens no card.
OutputListing listDisplays(const std::filesystem::path& folder = "/sys/class/drm");

/// When a display shows pictures.
struct DisplayTiming {
  FrameSize size;
  Duration period{0};     ///< between refreshes
  bool hasVblank = true;  ///< else its driver counts none, and pictures are paced by the clock
};

/// Of the display of that name, as for openDisplay(), in the mode that it has for a camera of
/// unknown rate. It is claimed, and released; no mode is set. Errors: as of openDisplay()'s
/// start(), but for those of setting the mode.
Result<DisplayTiming> displayTiming(const std::string& name,
                                    display::Cards& cards = display::kernelCards());

/// "display" and "display:CONNECTOR"; its options are `mode`, `fit`, `rotation`, `margin`, `drift`,
/// `scan_out`, `blank`, `blank_after`, `dim` and `dim_level`.
OutputKind displayKind();

}  // namespace pleinair::hal
