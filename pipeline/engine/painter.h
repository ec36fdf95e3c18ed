#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/parameter_values.h"
#include "hal/captured_frame.h"
#include "hal/error.h"
#include "hal/image.h"
#include "hal/surface.h"
#include "pipeline/engine/camera_path.h"
#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/frames/imported_texture.h"
#include "pipeline/gpu/gpu_loss.h"
#include "pipeline/gpu/programs/list_dispatch.h"
#include "pipeline/gpu/programs/pass_timer.h"
#include "pipeline/marks/anchors/anchor.h"
#include "pipeline/overlay/overlay_renderer.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/render/surface_snapshot.h"
#include "pipeline/tracking/pose/tracker.h"

namespace pleinair {

class FramePipeline;

/// The GL context that a Painter works in. A Painter has no thread: one thread creates, calls and
/// destroys it (the *paint thread* of docs/architecture.md).
enum class PainterContext {
  /// A context that the Painter creates. Each call makes it current on the calling thread. If
  /// another
  /// context was current there, it is current again when the call returns; otherwise the Painter's
  /// stays current, so that a thread that only paints never switches.
  kOwn,
  /// The host's context, which is current on the calling thread, always the same one. Each call
  /// works
  /// with any bindings and enabled capabilities of the host. It leaves nothing bound and all
  /// capabilities as in a new context; the viewport is restored.
  kHost,
};

/// A quality level, which determines the time and memory that painting takes.
struct QualityLevel {
  std::string name;
  std::string help;
};

/// All quality levels, best first. At each level a style takes little more than half of the time of
/// the level before. Work that does not depend on the picture's size (tracking, models, read-back)
/// takes the same time at all levels.
std::vector<QualityLevel> qualityLevels();

struct PainterOptions {
  hal::FrameSize pictureSize;  ///< size of the full picture; frames are scaled to fill it
  scene::Scene scene;          ///< empty: the camera's image alone
  std::string style = "watercolor";
  bool tracksTags = true;        ///< if unset, no tag is detected and no model appears
  bool isCameraMounted = false;  ///< tracking::ImageMotionOptions::isMounted
  PainterContext context = PainterContext::kOwn;
  std::filesystem::path shaderDirectory;  ///< overrides embedded shaders; empty: none
  gpu::PassTiming passTiming = gpu::PassTiming::kOff;
  /// The expected format of frames, for which all programs and buffers are prepared in advance;
  /// unset: the first frame may take longer. Frames of other formats are accepted too.
  std::optional<hal::FrameFormat> expectedFormat = std::nullopt;
  /// Allows PaintParameters::quality other than 0. All levels are allocated and warmed up then,
  /// which takes about twice the memory (docs/decisions/0008-quality-levels.md).
  bool qualityLevels = false;
  /// Whether surfaces() may be called; costs a pass over the models for styles without marks.
  bool readsSurfaces = false;
  /// Whether PaintParameters::overlay may be set.
  bool overlay = false;
  /// The model of the scene (index) that overlays are about; unset: there is only their
  /// instruction.
  std::optional<std::size_t> machine = std::nullopt;
  /// What painters of this scene before have found of its tags, and this one finds; null: nothing.
  std::shared_ptr<overlay::DoubtfulTags> doubtfulTags = nullptr;
  /// Called before each program that the constructor compiles, which takes up to 20 s without a
  /// shader cache in all: true ends it with a hal::Failure (kCancelled). Null: it cannot be
  /// cancelled.
  std::function<bool()> isCancelled = nullptr;
  /// An EGLDisplay of a window system, which PainterContext::kOwn makes its context on where that
  /// is no worse, to share textures with a window (gpu::EglContext); null: none.
  void* windows = nullptr;
  /// How full-screen passes run; unset: as is faster on the GPU.
  std::optional<gpu::PassForm> passForm = std::nullopt;
  /// How programs run over lists that the GPU makes; unset: as is faster on the GPU.
  std::optional<gpu::ListDispatch> listDispatch = std::nullopt;
  /// Replaces answers of the driver, in tests.
  gpu::GpuTestHook testHook = {};
};

/// The parameter set of a frame, with its debug view and quality level.
struct PaintParameters {
  config::ParameterValues style;  ///< values of the style's list: Painter::defaultParameters()
  std::string view;               ///< one of views(), or empty for the finished picture
  /// Index into qualityLevels(). A change keeps the history: the painting goes on, softer or
  /// sharper.
  std::size_t quality = 0;
  /// What is drawn over the finished picture, and over no other view: a step of a procedure, for
  /// PainterOptions::machine. Made for the full picture's size. Null: nothing.
  std::shared_ptr<const overlay::OverlayContent> overlay = nullptr;
};

/// A debug view, which can be painted instead of the finished picture.
struct DebugView {
  std::string name;
  std::string help;
};

/// The debug views of the engine, then those of a style. Needs no GPU. Throws hal::Failure
/// (kInvalidArgument, lists the valid names) for an unknown style. Any thread.
std::vector<DebugView> debugViewsOf(std::string_view style);

/// Checks a PaintParameters::view: empty, or one of debugViewsOf(style). Error: kInvalidArgument,
/// lists the valid names. Throws as debugViewsOf(). Any thread.
hal::Result<void> checkDebugView(std::string_view style, std::string_view view);

/// A painted picture. Its texture, in the Painter's context, and its list of tags belong to the
/// Painter and are valid until the next paint().
struct Picture {
  unsigned texture = 0;  ///< GL name, RGBA8, sRGB-coded, row 0 at the top
  hal::FrameSize size;   ///< smaller than PainterOptions::pictureSize at lower quality levels
  std::uint64_t sequence = 0;
  hal::TimePoint captureTime;
  tracking::TrackingResult tracking;  ///< in px of the captured frame
  std::size_t quality = 0;            ///< index into qualityLevels()
  /// What became of PaintParameters::overlay; unset where there was none.
  std::optional<overlay::OverlayState> overlay = std::nullopt;
};

/// A picture in memory, scaled and converted, as a read-back of the Painter gives it.
struct OutputFrame {
  hal::Image image;  ///< undefined where it was drawn into `surface`
  /// The one that has it, complete; unset: `image` has.
  std::optional<hal::LentSurface> surface = std::nullopt;
  std::uint64_t sequence = 0;
  hal::TimePoint captureTime;
};

/// The engine: captured frames in, painted pictures out. It has no globals; several Painters in one
/// process are independent. The same frames with the same times give the same pictures, live or
/// offline. All calls come from the thread that created it.
///
/// The GPU may be lost: a reset after a fault or a hang, a removed device, a fence that does not
/// signal within two seconds. From then on each call gives kDeviceLost and does nothing, and the
/// Painter can only be destroyed; another one can be created in the same process. In a host's
/// context, the host creates a new context first. The old context keeps the Painter's objects until
/// the host destroys it.
class Painter {
 public:
  /// Creates all stages and warms them up. Throws hal::Failure: no GPU, unknown style or tag family
  /// (lists the valid ones), a size beyond the limits, cancelled.
  explicit Painter(const PainterOptions& options);
  ~Painter();
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  const gpu::ContextInfo& contextInfo() const;
  PaintParameters defaultParameters() const;
  std::vector<DebugView> views() const;

  /// Tracks, composes and paints one frame of any size and layout. Returns when the work is issued,
  /// before the GPU is done. Errors that leave the Painter as it was: kInvalidArgument (unknown
  /// view or level, lists the valid ones), kInvalidInput (the frame's size is not that of the
  /// scene's calibration), kUnsupported (beyond the GPU's limits or memory). Permanent error:
  /// kDeviceLost. Precondition: frame.image.isComplete().
  hal::Result<Picture> paint(const hal::CapturedFrame& frame, const PaintParameters& parameters);

  /// Opens a read-back, at any time: from the next paint() on, each picture is also brought to
  /// memory in `format` (RGBA8, RGB8, grey, I420, NV12, YUYV; any accepted size, which the picture
  /// fills). Up to 3 output frames are in flight; while there are 3, pictures are skipped and
  /// counted. RGBA8 may be turned clockwise by right angles; `format` has the turned size. Returns
  /// the read-back's number, which is never reused. Compiles and allocates before it returns.
  /// Throws hal::Failure (kUnsupported if the GPU's limits or memory do not suffice, kDeviceLost).
  int openReadback(const hal::FrameFormat& format, int quarterTurns = 0);
  /// Closes a read-back, at any time, and drops its output frames in flight; other read-backs are
  /// not affected. Precondition, here and below: it is open.
  void closeReadback(int readback);

  /// The layouts of an output's surfaces that this Painter can draw pictures into.
  gpu::ImportSupport importSupport() const;
  /// Takes surfaces of an output (of the read-back's format, RGBA8) in place of earlier ones, and
  /// draws a pattern (hal::surfacePatternAt()) into each, to be compared. Waits for the GPU.
  /// Surfaces that pictures in flight are drawn into may be among the earlier ones. Errors:
  /// kUnsupported (the driver cannot), kDeviceLost (permanent).
  hal::Result<void> importSurfaces(int readback, std::span<const hal::GpuSurface> surfaces);
  /// The next picture is drawn into this one of the surfaces instead of being read back, and its
  /// output frame has it (OutputFrame::surface). Forgotten if the next paint() fails.
  void drawNextInto(int readback, const hal::LentSurface& surface);

  /// Copies the read-back's oldest output frame into `frame`, reusing its memory; false if none is
  /// ready. Never waits. Permanent error: kDeviceLost.
  hal::Answer poll(int readback, OutputFrame& frame);
  /// Like poll(), but waits for the GPU: false only if none is in flight.
  hal::Answer wait(int readback, OutputFrame& frame);
  /// Waits until the first output frame in flight, of all read-backs, can be polled, at most for
  /// `limit` of real time; returns whether it can. False at once if none is in flight. Sleeps in
  /// the driver (glClientWaitSync). Permanent error: kDeviceLost.
  hal::Answer waitForAny(hal::Duration limit);
  /// Whether the next picture would be read and not skipped.
  bool hasRoom(int readback) const;
  std::uint64_t skipped(int readback) const;  ///< number of skipped pictures

  /// snapshot() reads the last picture, cameraSnapshot() the camera's part of it, and
  /// composedSnapshot() the camera's picture with the models in it, before the style; as RGB8 of
  /// the full size. They wait for the GPU. Errors: kDeviceLost (permanent), kUnsupported (no
  /// memory). Precondition: a picture was painted.
  hal::Result<hal::Image> snapshot() const;
  hal::Result<hal::Image> cameraSnapshot() const;
  hal::Result<hal::Image> composedSnapshot() const;

  /// Waits for the GPU and reads which points of the models the last picture shows, for measures;
  /// in px of its quality level. Permanent error: kDeviceLost. Preconditions: a picture was
  /// painted, and PainterOptions::readsSurfaces.
  hal::Result<scene::SurfaceSnapshot> surfaces() const;

  /// Waits for the GPU and reads the style's anchors for measures: all slots of all layers, free
  /// ones too. Empty for a style without anchors. Permanent error: kDeviceLost.
  hal::Result<std::vector<marks::Anchor>> anchors() const;
  /// Waits for the GPU and reads which places the style takes for movers, for measures: grey, 255
  /// on them, at half the full size. Nothing for a style that tells no movers. Errors: kDeviceLost
  /// (permanent), kUnsupported (a texture that cannot be read).
  hal::Result<std::optional<hal::Image>> movers() const;

  /// How frames have reached the GPU and the trackers so far. Valid until the next paint().
  const CameraPath& cameraPath() const;
  /// Where the labels of the last overlay are, in its order; empty where it has none. For measures.
  std::span<const overlay::PlacedLabel> overlayLabels() const;

  /// Discards all history, as after a cut.
  void reset();
  /// Times of each pass so far; empty if PainterOptions::passTiming is kOff. kSampled times one
  /// frame in gpu::PassTimer::kSampledEvery. Valid until the next paint().
  std::span<const gpu::PassTime> passTimes() const;

 private:
  std::unique_ptr<FramePipeline> pipeline_;
};

}  // namespace pleinair
