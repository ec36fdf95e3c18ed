#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "hal/key_pressed.h"
#include "hal/output.h"
#include "hal/output_kind.h"

namespace pleinair::hal {

/// The user wants it gone; it stays until it is destroyed.
struct WindowClosed {
  friend bool operator==(const WindowClosed&, const WindowClosed&) = default;
};
struct WindowResized {
  FrameSize size;  ///< in pixels of the screen, which a picture is scaled to
  friend bool operator==(const WindowResized&, const WindowResized&) = default;
};
using WindowEvent = std::variant<KeyPressed, WindowClosed, WindowResized>;

/// How a window stands on its desktop, and what people at it may do: the keys of [output.window].
struct WindowSettings {
  bool isFullScreen = false;     ///< from the start
  std::string display = "auto";  ///< or a number from 1, or a part of a display's name
  int quarterTurns = 0;          ///< clockwise, of pictures
  bool isMirrored = false;       ///< pictures, left and right, before they are turned
  /// Whether keys and the closing of the window are events; else the keyboard is kept from the
  /// desktop, too, and captions are not shown.
  bool takesKeys = true;
  bool hidesCursor = false;  ///< always; else in full screen only
  /// Whether it lends textures that a painter draws straight into, where it can: where it is drawn
  /// by a GPU, always, or never. Software takes turns at drawing for two contexts of one display.
  enum class Lending { kByGpus, kAlways, kNever };
  Lending lending = Lending::kByGpus;
  friend bool operator==(const WindowSettings&, const WindowSettings&) = default;
};

/// A window on a desktop: the last picture, scaled to fit, with black bars where the shapes differ.
/// All of it, over all windows of the process, on one thread, which is asserted.
///
/// start() shows it in the picture's size where that fits the screen, and answers RGBA8 and the
/// period of the screen's refresh. Where it is drawn by OpenGL ES through EGL, it lends textures
/// (lender()) to painters whose context is on the same EGL display, and is drawn from them; after
/// start(). Errors of start() also: kNotFound (no such display; lists them).
class Window : public MemoryOutput {
 public:
  /// The events since the last call, oldest first. To be called several times a second; otherwise
  /// the desktop reports that the program does not respond.
  virtual std::vector<WindowEvent> takeEvents() = 0;

  // These show with the next write() or redraw().

  /// Lines over the lower left corner, in the window's pixels; '\t' goes to a second column.
  /// `opacity` from 0 (nothing is drawn) to 1.
  virtual void setCaption(const std::string& text, double opacity) = 0;
  /// The last picture again, with the caption as it is now.
  virtual Result<void> redraw() = 0;

  virtual void setTitle(const std::string& title) = 0;
  virtual void setFullScreen(bool on) = 0;
  /// Puts a text on the desktop's clipboard, where the window keeps it as long as it lives.
  virtual void setClipboard(const std::string& text) = 0;

  /// The content of the window as RGB8, drawn again for this call. Errors: kDeviceLost.
  virtual Result<Image> shown() = 0;
};

/// A window through SDL, on the display that the environment names; start() shows it. Errors:
/// kNotFound (there is no display), kUnsupported (this build has no window).
Result<std::unique_ptr<Window>> openWindow(WindowSettings settings = {});

/// "window".
OutputKind windowKind();

}  // namespace pleinair::hal
