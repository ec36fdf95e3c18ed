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
#include "pipeline/gpu/egl_context.h"
#include "pipeline/gpu/gpu_loss.h"
#include "pipeline/gpu/pass_timer.h"
#include "pipeline/marks/anchor.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/tracking/pose/tracker.h"

namespace pleinair {

class FramePipeline;

/// Whose GL context a Painter works in. Either way the Painter has no thread of its own: one thread
/// makes it, calls it and destroys it (the *paint thread* of docs/architecture.md).
enum class PainterContext {
  /// Its own, made with it. Each call makes it current on the calling thread. A context of somebody
  /// else that was current there is current again when the call returns; where none was, the
  /// Painter's stays, so that a thread that only paints never switches.
  kOwn,
  /// The one that is current on the calling thread, always the same. Each call works whatever the
  /// host has bound and switched on, and leaves nothing bound and all switches as in a new context;
  /// the viewport stays.
  kHost,
};

/// A level of quality, from which the time and memory of painting follow.
struct QualityLevel {
  std::string name;
  std::string help;
};

/// All levels, best first. A style takes about two thirds of the time of the level before; what
/// does not depend on the picture's size (tracking, models, read-back) stays.
std::vector<QualityLevel> qualityLevels();

struct PainterOptions {
  hal::FrameSize pictureSize;  ///< of what is painted; frames are scaled to fill it
  scene::Scene scene;          ///< empty: the camera's picture alone
  std::string style = "watercolor";
  bool tracksTags = true;  ///< without, no tag is looked for and no model appears
  PainterContext context = PainterContext::kOwn;
  std::filesystem::path shaderDirectory;  ///< overrides embedded shaders; empty: none
  gpu::PassTiming passTiming = gpu::PassTiming::kOff;
  /// The format of the frames to come, for which everything is compiled and allocated in advance;
  /// unset: the first frame may take longer. Frames of other formats are accepted too.
  std::optional<hal::FrameFormat> expectedFormat = std::nullopt;
  /// Whether PaintParameters::quality may be other than 0: all levels are allocated and warmed up
  /// then, for about twice the memory (docs/decisions/0008-quality-levels.md).
  bool qualityLevels = false;
  /// Asked before each program that the making of a Painter compiles, which takes up to 20 s
  /// without a shader cache: true ends it with a hal::Failure (kCancelled). Null: it cannot be
  /// cancelled.
  std::function<bool()> isCancelled = nullptr;
  /// In place of what the driver is asked; for tests.
  gpu::GpuTestHook testHook = {};
};

/// The parameter set of a frame, with its debug view and quality level.
struct PaintParameters {
  config::ParameterValues style;  ///< of the style's list: Painter::defaultParameters()
  std::string view;               ///< empty for the finished picture, or one of views()
  /// In qualityLevels(). A change keeps the past: the picture goes on, softer or sharper.
  std::size_t quality = 0;
};

/// A view that can be painted instead of the finished picture.
struct DebugView {
  std::string name;
  std::string help;
};

/// The views of a style, the engine's own first, without a GPU. Throws hal::Failure
/// (kInvalidArgument) for an unknown style, with all names.
std::vector<DebugView> debugViewsOf(std::string_view style);

/// Whether PaintParameters::view may be `view`: empty, or one of debugViewsOf(style). Error:
/// kInvalidArgument, with all names. Throws as debugViewsOf(). Any thread.
hal::Result<void> checkDebugView(std::string_view style, std::string_view view);

/// A named preset of the style's parameters.
struct PainterLook {
  std::string name;
  std::string help;
};

/// A painted picture. Its texture, which lives in the Painter's context, and the list of its tags
/// belong to the Painter and are valid until the next paint().
struct Picture {
  unsigned texture = 0;  ///< GL name, RGBA8, sRGB-coded, row 0 at the top
  hal::FrameSize size;   ///< smaller than PainterOptions::pictureSize at lower levels of quality
  std::uint64_t sequence = 0;
  hal::TimePoint captureTime;
  tracking::TrackingResult tracking;  ///< in pixels of the captured frame
  std::size_t quality = 0;            ///< in qualityLevels()
};

/// A picture in memory, as a read-back of the Painter gives it.
struct OutputFrame {
  hal::Image image;
  std::uint64_t sequence = 0;
  hal::TimePoint captureTime;
};

/// The engine: captured frames in, painted pictures out. No globals; several in one process are
/// independent, and the same frames with the same times give the same pictures, live or not. All
/// calls come from the thread that made it.
///
/// The GPU may be lost (a reset after a fault or a hang, a device taken away, a fence that does not
/// come within two seconds). From then on this Painter answers each call with kDeviceLost, does
/// nothing and can only be destroyed; another one can be made in the same process. In a host's
/// context, the host makes a new context first, and the old one keeps what the Painter had in it
/// until the host destroys it.
class Painter {
 public:
  /// Builds the whole chain and warms it up. Throws hal::Failure (no GPU, unknown style or tag
  /// family: lists the valid ones, size beyond the limits).
  explicit Painter(const PainterOptions& options);
  ~Painter();
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  const gpu::ContextInfo& contextInfo() const;
  PaintParameters defaultParameters() const;
  std::vector<DebugView> views() const;
  std::vector<PainterLook> looks() const;
  /// The style's defaults under a look's values. Throws config::ConfigError for an unknown one,
  /// with all names.
  config::ParameterValues lookParameters(std::string_view look) const;

  /// Tracks, composes and paints one frame, which may have any size and layout. Returns when the
  /// work is issued, not when the GPU is done. Errors, after which all is as if the frame had not
  /// come: kInvalidArgument (unknown view or level: lists the valid ones), kInvalidInput (the frame
  /// has another size than the scene's calibration is for), kUnsupported (beyond the GPU's limits
  /// or memory). Then, for ever: kDeviceLost. Precondition: frame.image.isComplete().
  hal::Result<Picture> paint(const hal::CapturedFrame& frame, const PaintParameters& parameters);

  /// Opens a read-back, at any time: from the next paint() on, each painted picture is also brought
  /// to memory in `format` (RGBA8, RGB8, grey, I420, NV12, YUYV; of any accepted size, filled as
  /// frames are). Up to 3 are in flight; a picture that finds the read-back full is not read and
  /// counts as skipped. Returns the read-back's number, which no other gets. Waits until what it
  /// needs is compiled and allocated. Throws hal::Failure (kUnsupported where the GPU has no room
  /// for it, kDeviceLost).
  int openReadback(const hal::FrameFormat& format);
  /// Closes a read-back, at any time; its pictures in flight are dropped, and those of other
  /// read-backs come as before. Precondition, as for all that follows: it is open.
  void closeReadback(int readback);
  /// Copies the read-back's oldest picture into `picture`, reusing its memory; false if none is
  /// ready. Never waits. Error: kDeviceLost, for ever.
  hal::Answer poll(int readback, OutputFrame& picture);
  /// The same, but waits for the GPU: false only if none is in flight.
  hal::Answer wait(int readback, OutputFrame& picture);
  /// Waits until the picture that will be ready first, of all read-backs, can be polled, but no
  /// longer than `limit` of real time: whether it can. False at once if none is in flight. Sleeps
  /// in the driver (glClientWaitSync). Error: kDeviceLost, for ever.
  hal::Answer waitForAny(hal::Duration limit);
  /// Whether another paint() would still be read.
  bool hasRoom(int readback) const;
  std::uint64_t skipped(int readback) const;

  /// Waits for the last paint and reads it, or what the camera showed of it, as RGB8 of the
  /// picture's full size: for snapshots. Errors: kDeviceLost, for ever; kUnsupported (no memory).
  /// Precondition: something was painted.
  hal::Result<hal::Image> snapshot() const;
  hal::Result<hal::Image> cameraSnapshot() const;

  /// Waits for the last paint and reads the style's anchors, of all its layers, a slot each, free
  /// ones too: for measures. Empty for a style without. Error: kDeviceLost, for ever.
  hal::Result<std::vector<marks::Anchor>> anchors() const;

  /// Forgets the past, as after a cut.
  void reset();
  /// The times of each pass so far, where PainterOptions::passTiming asked for them: kSampled for
  /// products, which times one frame in gpu::PassTimer::kSampledEvery. Valid until the next
  /// paint().
  std::span<const gpu::PassTime> passTimes() const;

 private:
  std::unique_ptr<FramePipeline> pipeline_;
};

}  // namespace pleinair
