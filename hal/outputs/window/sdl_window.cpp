#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hal/outputs/window/caption.h"
#include "hal/outputs/window/key_name.h"
#include "hal/outputs/window/lent_textures.h"
#include "hal/outputs/window/sdl_video.h"
#include "hal/outputs/window/window.h"
#include "hal/outputs/window/window_layout.h"

namespace pleinair::hal {
namespace {

namespace display_connection = window::display_connection;

using window::RendererHandle;
using window::SdlVideo;
using window::TextureHandle;
using window::WindowHandle;

constexpr const char* kSubject = "window";
constexpr const char* kSelf = "self";  // under which an SDL window knows its SdlWindow

Error failure(ErrorKind kind, const char* problem, std::string remedy = {}) {
  return {.kind = kind,
          .subject = kSubject,
          .problem = std::string(problem) + ": " + SDL_GetError(),
          .remedy = std::move(remedy)};
}

Error displayLost() {
  return {.kind = ErrorKind::kDeviceLost,
          .subject = kSubject,
          .problem = "the display server is gone",
          .remedy = "start the program again once it is back"};
}

/// A renderer on OpenGL ES where there is a GPU; SDL's choice otherwise, its software at the worst.
RendererHandle makeRenderer(SDL_Window* window) {
  for (int i = 0; i < SDL_GetNumRenderDrivers(); ++i) {
    SDL_RendererInfo info{};
    if (SDL_GetRenderDriverInfo(i, &info) != 0 || std::string(info.name) != "opengles2") continue;
    constexpr auto kFlags = SDL_RENDERER_ACCELERATED | SDL_RENDERER_PRESENTVSYNC;
    RendererHandle renderer(SDL_CreateRenderer(window, i, kFlags));
    if (renderer != nullptr) return renderer;
  }
  return RendererHandle(SDL_CreateRenderer(window, -1, 0));
}

/// SDL tells the period only.
std::optional<Refresh> refreshOf(SDL_Window* window) {
  SDL_DisplayMode mode{};
  if (SDL_GetWindowDisplayMode(window, &mode) != 0 || mode.refresh_rate <= 0) return std::nullopt;
  return Refresh{.period = Duration(std::chrono::seconds(1)) / mode.refresh_rate, .phase = {}};
}

class SdlWindow final : public Window, public GpuSurfaceLender {
 public:
  SdlWindow(SdlVideo video, WindowSettings settings)
      : video_(std::move(video)), settings_(std::move(settings)) {}
  ~SdlWindow() override {
    if (display_connection::isLost()) abandon();
  }
  SdlWindow(const SdlWindow&) = delete;
  SdlWindow& operator=(const SdlWindow&) = delete;

  OutputIdentity identity() const override { return {.backend = "window", .id = "window"}; }
  Result<OutputFormat> start(const OutputRequest& request) override;
  Result<void> write(const ImageView& picture, Duration time) override;
  Result<OutputFormat> reconfigure(const OutputRequest& request) override;
  Result<void> finish() override { return {}; }

  GpuSurfaceLender* lender() override { return this; }
  Result<void*> eglDisplay() override;
  Result<std::vector<GpuSurface>> lendToGpu(std::span<const std::uint64_t> modifiers,
                                            std::size_t count) override;
  Result<std::optional<SurfaceId>> acquireForGpu() override;
  Result<Image> copyOfGpuSurface(SurfaceId surface, bool isWholeBuffer) override;
  Result<void> show(SurfaceId surface, Duration time) override;

  std::vector<WindowEvent> takeEvents() override;
  void setCaption(const std::string& text, double opacity) override;
  Result<void> redraw() override;
  void setTitle(const std::string& title) override;
  void setFullScreen(bool on) override;
  void setClipboard(const std::string& text) override;
  Result<Image> shown() override;

 private:
  Result<void> open(FrameSize picture);
  Result<void> makeTexture(FrameSize picture);
  /// The size that a picture of `size` is seen in.
  FrameSize turned(FrameSize size) const {
    return settings_.quarterTurns % 2 == 0 ? size : FrameSize{size.height, size.width};
  }
  Result<void> draw();
  Result<void> present();
  /// Fills the screen without a window manager, or goes back to the place before.
  void fillScreen(bool on);
  /// The size of the drawable, which on dense screens has more pixels than the window has units.
  FrameSize pixelSize() const;
  double pixelScale() const;
  /// Puts an event of SDL's into the queue of the window that it is for.
  void route(const SDL_Event& event);
  void accept(const SDL_WindowEvent& event);
  /// Leaves what SDL holds to the process's end.
  void abandon();
  bool isStarted() const { return texture_ != nullptr && SdlVideo::isOnItsThread(); }

  FrameFormat format_;
  SdlVideo video_;
  WindowSettings settings_;
  bool isFullScreen_ = false;
  WindowHandle window_;
  RendererHandle renderer_;
  TextureHandle texture_;
  window::LentTextures lent_;
  Result<void*> display_ = nullptr;  ///< LentTextures::displayOf()
  window::Caption caption_;
  bool hasPicture_ = false;
  SDL_Rect placeBefore_{};  ///< before the window filled the screen
  std::vector<WindowEvent> events_;
};

Error unacceptedSize() {
  return {.kind = ErrorKind::kUnsupported,
          .subject = kSubject,
          .problem = "cannot take this size",
          .remedy = "use 1 to 8192 px a side and at most 64 Mpx"};
}

/// The number of the display that is asked for, from 0.
Result<int> displayOf(const std::string& wanted) {
  if (wanted == "auto") return 0;
  std::string known;
  // A name may hold digits, too: "2" is the second one, also beside a "DELL U2720Q".
  const bool isNumber = std::ranges::all_of(wanted, [](char c) { return c >= '0' && c <= '9'; });
  const int count = SDL_GetNumVideoDisplays();
  for (int i = 0; i < count; ++i) {
    const char* const name = SDL_GetDisplayName(i);
    const std::string text = name == nullptr ? "" : name;
    const bool isIt =
        isNumber ? wanted == std::to_string(i + 1) : text.find(wanted) != std::string::npos;
    if (isIt) return i;
    known += (known.empty() ? "" : ", ") + std::to_string(i + 1) + " (" + text + ")";
  }
  return tl::unexpected(Error{.kind = ErrorKind::kNotFound,
                              .subject = kSubject,
                              .problem = "there is no display " + wanted,
                              .remedy = "give auto, or one of " + known});
}

Result<OutputFormat> SdlWindow::start(const OutputRequest& request) {
  assert(window_ == nullptr && SdlVideo::isOnItsThread());
  if (!isAcceptedSize(request.size)) return tl::unexpected(unacceptedSize());
  format_ = {.pixelFormat = PixelFormat::kRgba8, .size = request.size};
  if (Result<void> opened = open(request.size); !opened) return tl::unexpected(opened.error());
  if (settings_.isFullScreen) setFullScreen(true);
  if (settings_.hidesCursor) SDL_ShowCursor(SDL_DISABLE);
  if (!settings_.takesKeys) SDL_SetWindowKeyboardGrab(window_.get(), SDL_TRUE);
  return OutputFormat{
      .frame = format_, .refresh = refreshOf(window_.get()), .isMirrored = settings_.isMirrored};
}

Result<OutputFormat> SdlWindow::reconfigure(const OutputRequest& request) {
  assert(isStarted());
  if (display_connection::isLost()) return tl::unexpected(displayLost());
  if (!isAcceptedSize(request.size)) return tl::unexpected(unacceptedSize());
  if (Result<void> made = makeTexture(request.size); !made) return tl::unexpected(made.error());
  format_.size = request.size;
  hasPicture_ = false;
  lent_.clear();
  if (!isFullScreen_) {
    const int display = std::max(0, SDL_GetWindowDisplayIndex(window_.get()));
    SDL_Rect room{.x = 0, .y = 0, .w = request.size.width, .h = request.size.height};
    SDL_GetDisplayUsableBounds(display, &room);
    const FrameSize size = window::openingSize(turned(request.size), {room.w, room.h});
    const auto centred =
        static_cast<int>(SDL_WINDOWPOS_CENTERED_DISPLAY(static_cast<unsigned>(display)));
    SDL_SetWindowSize(window_.get(), size.width, size.height);
    SDL_SetWindowPosition(window_.get(), centred, centred);
  }
  return OutputFormat{
      .frame = format_, .refresh = refreshOf(window_.get()), .isMirrored = settings_.isMirrored};
}

Result<void> SdlWindow::open(FrameSize picture) {
  const Result<int> display = displayOf(settings_.display);
  if (!display) return tl::unexpected(display.error());
  SDL_Rect room{.x = 0, .y = 0, .w = picture.width, .h = picture.height};
  SDL_GetDisplayUsableBounds(*display, &room);
  const FrameSize size = window::openingSize(turned(picture), {room.w, room.h});
  constexpr auto kFlags = SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI;
  const auto centred =
      static_cast<int>(SDL_WINDOWPOS_CENTERED_DISPLAY(static_cast<unsigned>(*display)));
  window_.reset(SDL_CreateWindow("pleinair", centred, centred, size.width, size.height, kFlags));
  if (window_ == nullptr) return tl::unexpected(failure(ErrorKind::kIo, "cannot open"));
  display_connection::watch(window_.get());
  SDL_SetWindowData(window_.get(), kSelf, this);
  renderer_ = makeRenderer(window_.get());
  if (renderer_ == nullptr) return tl::unexpected(failure(ErrorKind::kIo, "cannot draw"));
  if (Result<void> made = makeTexture(picture); !made) return made;
  if (Result<void> drawn = draw(); !drawn) return drawn;
  display_ = window::LentTextures::displayOf(renderer_.get(),
                                             settings_.lending == WindowSettings::Lending::kAlways);
  return {};
}

Result<void> SdlWindow::makeTexture(FrameSize picture) {
  TextureHandle texture(SDL_CreateTexture(renderer_.get(), SDL_PIXELFORMAT_RGBA32,
                                          SDL_TEXTUREACCESS_STREAMING, picture.width,
                                          picture.height));
  if (texture == nullptr) {
    return tl::unexpected(
        failure(ErrorKind::kUnsupported, "cannot take this size", "choose a smaller --size"));
  }
  SDL_SetTextureBlendMode(texture.get(), SDL_BLENDMODE_NONE);
  SDL_SetTextureScaleMode(texture.get(), SDL_ScaleModeLinear);
  texture_ = std::move(texture);
  return {};
}

FrameSize SdlWindow::pixelSize() const {
  FrameSize size{1, 1};
  SDL_GetRendererOutputSize(renderer_.get(), &size.width, &size.height);
  return {std::max(1, size.width), std::max(1, size.height)};
}

double SdlWindow::pixelScale() const {
  int height = 0;
  SDL_GetWindowSize(window_.get(), nullptr, &height);
  return static_cast<double>(pixelSize().height) / std::max(1, height);
}

Result<void> SdlWindow::draw() {
  SDL_SetRenderDrawColor(renderer_.get(), 0, 0, 0, SDL_ALPHA_OPAQUE);
  if (SDL_RenderClear(renderer_.get()) != 0) {
    return tl::unexpected(failure(ErrorKind::kDeviceLost, "cannot draw"));
  }
  const window::Area area =
      window::turnedLetterBox(format_.size, pixelSize(), settings_.quarterTurns);
  const SDL_Rect box{.x = area.x, .y = area.y, .w = area.size.width, .h = area.size.height};
  const auto flip = settings_.isMirrored ? SDL_FLIP_HORIZONTAL : SDL_FLIP_NONE;
  const bool isPlain = settings_.quarterTurns == 0 && !settings_.isMirrored;
  SDL_Texture* const picture = lent_.seen() != nullptr ? lent_.seen() : texture_.get();
  const auto copy = [&] {
    if (isPlain) return SDL_RenderCopy(renderer_.get(), picture, nullptr, &box);
    return SDL_RenderCopyEx(renderer_.get(), picture, nullptr, &box, 90.0 * settings_.quarterTurns,
                            nullptr, flip);
  };
  if (hasPicture_ && copy() != 0) {
    return tl::unexpected(failure(ErrorKind::kDeviceLost, "cannot draw"));
  }
  caption_.draw(renderer_.get(), pixelScale());
  return {};
}

Result<void> SdlWindow::write(const ImageView& picture, Duration) {
  assert(isStarted() && picture.format == format_ && picture.isComplete());
  if (display_connection::isLost()) return tl::unexpected(displayLost());
  void* pixels = nullptr;
  int strideBytes = 0;
  if (SDL_LockTexture(texture_.get(), nullptr, &pixels, &strideBytes) != 0) {
    return tl::unexpected(failure(ErrorKind::kDeviceLost, "cannot take a picture"));
  }
  for (int y = 0; y < format_.size.height; ++y) {
    const auto row = picture.row(0, y);
    std::ranges::copy(row, static_cast<std::uint8_t*>(pixels) + std::ptrdiff_t{strideBytes} * y);
  }
  SDL_UnlockTexture(texture_.get());
  lent_.hide();
  hasPicture_ = true;
  return redraw();
}

Result<void*> SdlWindow::eglDisplay() {
  if (settings_.lending != WindowSettings::Lending::kNever) return display_;
  return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                              .subject = kSubject,
                              .problem = "is set to copy pictures (scan_out)",
                              .remedy = {}});
}

Result<std::vector<GpuSurface>> SdlWindow::lendToGpu(std::span<const std::uint64_t> /*modifiers*/,
                                                     std::size_t count) {
  assert(isStarted());
  if (display_connection::isLost()) return tl::unexpected(displayLost());
  if (const Result<void*> display = eglDisplay(); !display) return tl::unexpected(display.error());
  return lent_.lend(renderer_.get(), format_.size, count);
}

Result<std::optional<SurfaceId>> SdlWindow::acquireForGpu() {
  assert(isStarted());
  if (display_connection::isLost()) return tl::unexpected(displayLost());
  return lent_.acquire();
}

Result<Image> SdlWindow::copyOfGpuSurface(SurfaceId surface, bool isWholeBuffer) {
  assert(isStarted());
  if (display_connection::isLost()) return tl::unexpected(displayLost());
  if (!isWholeBuffer && !lent_.isSeen(surface)) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = kSubject,
                                .problem = "has another picture by now",
                                .remedy = {}});
  }
  return lent_.copy(renderer_.get(), surface);
}

Result<void> SdlWindow::show(SurfaceId surface, Duration) {
  assert(isStarted());
  if (display_connection::isLost()) return tl::unexpected(displayLost());
  lent_.show(surface);
  hasPicture_ = true;
  return redraw();
}

Result<void> SdlWindow::redraw() {
  assert(isStarted());
  if (display_connection::isLost()) return tl::unexpected(displayLost());
  if (Result<void> drawn = draw(); !drawn) return drawn;
  return present();
}

/// What was drawn. Nothing is swapped once the connection is known to be broken.
Result<void> SdlWindow::present() {
  SDL_RenderFlush(renderer_.get());
  if (display_connection::isLost()) return tl::unexpected(displayLost());
  SDL_RenderPresent(renderer_.get());
  if (display_connection::isLost()) return tl::unexpected(displayLost());
  lent_.drawn();
  return {};
}

void SdlWindow::abandon() {
  caption_.abandon();
  static_cast<void>(texture_.release());
  static_cast<void>(renderer_.release());
  static_cast<void>(window_.release());
}

Result<Image> SdlWindow::shown() {
  assert(isStarted());
  if (display_connection::isLost()) return tl::unexpected(displayLost());
  if (Result<void> drawn = draw(); !drawn) return tl::unexpected(drawn.error());
  Image image({.pixelFormat = PixelFormat::kRgb8, .size = pixelSize()});
  // Before it is presented: afterwards it may be gone.
  if (SDL_RenderReadPixels(renderer_.get(), nullptr, SDL_PIXELFORMAT_RGB24, image.plane(0).data(),
                           3 * image.size().width) != 0) {
    return tl::unexpected(failure(ErrorKind::kDeviceLost, "cannot read what it shows"));
  }
  if (Result<void> presented = present(); !presented) return tl::unexpected(presented.error());
  return image;
}

std::vector<WindowEvent> SdlWindow::takeEvents() {
  assert(isStarted());
  SDL_Event event;
  while (!display_connection::isLost() && SDL_PollEvent(&event) != 0) route(event);
  return std::exchange(events_, {});
}

void SdlWindow::route(const SDL_Event& event) {
  // Null for one that a host program has opened, or that did not start.
  const auto started = [](SDL_Window* named) {
    auto* const self = static_cast<SdlWindow*>(SDL_GetWindowData(named, kSelf));
    return self != nullptr && self->isStarted() ? self : nullptr;
  };
  if (event.type == SDL_WINDOWEVENT) {
    SDL_Window* const named = SDL_GetWindowFromID(event.window.windowID);
    SdlWindow* const self = named == nullptr ? nullptr : started(named);  // one that is gone
    if (self != nullptr) self->accept(event.window);
  } else if (event.type == SDL_KEYDOWN) {
    SDL_Window* const named = SDL_GetWindowFromID(event.key.windowID);
    // Without the focus a key is nobody's: the one that asks takes it.
    SdlWindow* const self = named == nullptr ? this : started(named);
    std::string name = window::keyName(event.key.keysym);
    if (name.empty() || self == nullptr || !self->settings_.takesKeys) return;
    const bool shift = (event.key.keysym.mod & KMOD_SHIFT) != 0;
    self->events_.emplace_back(
        KeyPressed{.name = std::move(name), .shift = shift, .isRepeat = event.key.repeat != 0});
  }
}

void SdlWindow::accept(const SDL_WindowEvent& event) {
  switch (event.event) {
    case SDL_WINDOWEVENT_CLOSE:
      if (settings_.takesKeys) events_.emplace_back(WindowClosed{});
      break;
    case SDL_WINDOWEVENT_SIZE_CHANGED:
      events_.emplace_back(WindowResized{pixelSize()});
      [[fallthrough]];
    case SDL_WINDOWEVENT_EXPOSED:
      static_cast<void>(redraw());  // the next write() says what is wrong
      break;
    default:
      break;
  }
}

void SdlWindow::setCaption(const std::string& text, double opacity) {
  assert(SdlVideo::isOnItsThread());
  if (display_connection::isLost() || !settings_.takesKeys) return;
  caption_.set(text, opacity);
}

void SdlWindow::setTitle(const std::string& title) {
  assert(isStarted());
  if (display_connection::isLost()) return;
  // Each time the desktop is told, and this may be called for every picture.
  if (title == SDL_GetWindowTitle(window_.get())) return;
  SDL_SetWindowTitle(window_.get(), title.c_str());
}

void SdlWindow::setFullScreen(bool on) {
  assert(isStarted());
  if (display_connection::isLost()) return;
  if (display_connection::hasWindowManager(window_.get())) {
    SDL_SetWindowFullscreen(window_.get(), on ? SDL_WINDOW_FULLSCREEN_DESKTOP : 0);
  } else {
    fillScreen(on);  // SDL would believe that it did, and show a part of the picture
  }
  isFullScreen_ = on;
  SDL_ShowCursor(on || settings_.hidesCursor ? SDL_DISABLE : SDL_ENABLE);
}

void SdlWindow::setClipboard(const std::string& text) {
  assert(isStarted());
  if (!display_connection::isLost()) SDL_SetClipboardText(text.c_str());
}

void SdlWindow::fillScreen(bool on) {
  if (on) {
    SDL_GetWindowPosition(window_.get(), &placeBefore_.x, &placeBefore_.y);
    SDL_GetWindowSize(window_.get(), &placeBefore_.w, &placeBefore_.h);
  }
  SDL_Rect place = placeBefore_;
  if (on && SDL_GetDisplayBounds(SDL_GetWindowDisplayIndex(window_.get()), &place) != 0) return;
  SDL_SetWindowPosition(window_.get(), place.x, place.y);
  SDL_SetWindowSize(window_.get(), place.w, place.h);
}

}  // namespace

Result<std::unique_ptr<Window>> openWindow(WindowSettings settings) {
  Result<SdlVideo> video = SdlVideo::open();
  if (!video) return tl::unexpected(std::move(video.error()));
  return std::make_unique<SdlWindow>(*std::move(video), std::move(settings));
}

}  // namespace pleinair::hal
