#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/image.h"
#include "hal/surface.h"

namespace pleinair::hal {

/// The stream that the pipeline offers to an output.
struct OutputRequest {
  FrameSize size;
  std::optional<Duration> framePeriod;  ///< nominal, where the source has one
};

/// When a display changes its picture: at `phase` and every `period` before and after it.
struct Refresh {
  Duration period;
  std::optional<TimePoint> phase;  ///< one of those moments, on the steady clock; unset: unknown
  /// The display's count at `phase`; unset where it does not count, or the phase is unknown.
  std::optional<std::uint64_t> sequence = std::nullopt;
  friend bool operator==(const Refresh&, const Refresh&) = default;
};

/// The first of the refreshes `phase` ± n · `period` at or after `time`. Precondition: a period
/// above zero.
constexpr TimePoint refreshAtOrAfter(TimePoint time, TimePoint phase, Duration period) {
  Duration past = (time - phase) % period;
  if (past < Duration::zero()) past += period;
  return past == Duration::zero() ? time : time + (period - past);
}

/// The display's count at the refresh nearest to `time`; nothing where the display does not count.
/// Precondition: a period above zero.
constexpr std::optional<std::uint64_t> sequenceAt(TimePoint time, const Refresh& refresh) {
  if (!refresh.phase || !refresh.sequence) return std::nullopt;
  const Duration half = refresh.period / 2;
  const TimePoint next = refreshAtOrAfter(time - half, *refresh.phase, refresh.period);
  return *refresh.sequence + static_cast<std::uint64_t>((next - *refresh.phase) / refresh.period);
}

/// The format that an output takes. The pipeline scales and converts to it (pipeline/present).
struct OutputFormat {
  FrameFormat frame;
  std::optional<Refresh> refresh;  ///< of a display; unset where there is none
  /// By how many right angles pictures are turned clockwise, for a display that hangs so. `frame`
  /// is their format when they have been turned.
  int quarterTurns = 0;
  /// People see pictures with left and right exchanged: texts in them are exchanged beforehand.
  bool isMirrored = false;
};

struct OutputIdentity {
  std::string backend;  ///< "movie", "frames", "headless" …
  std::string id;       ///< path or device
};

class MemoryOutput;
class SurfaceOutput;

/// Surfaces that a GPU draws into, of an output that has such beside its other ways to take
/// pictures. All calls come from the output's thread.
class GpuSurfaceLender {
 public:
  virtual ~GpuSurfaceLender() = default;

  /// The EGLDisplay whose contexts alone share the surfaces (GpuSurface::texture); null: they have
  /// descriptors, for any GPU. Error: kUnsupported (why there are no surfaces).
  virtual Result<void*> eglDisplay() { return nullptr; }

  /// Makes `count` surfaces that a GPU draws into; where they have descriptors, in layouts that it
  /// takes (modifiers of drm_fourcc.h, for XRGB8888). Those of an earlier call are lent no more,
  /// and what was drawn into them cannot be shown. Their descriptors stay open until the next call,
  /// a reconfiguration, an error or destruction. May take some 100 ms. Errors: kUnsupported (why
  /// there are none), kNoSpace (no memory), kDeviceLost.
  virtual Result<std::vector<GpuSurface>> lendToGpu(std::span<const std::uint64_t> modifiers,
                                                    std::size_t count) = 0;
  /// One of them that is free; nothing where all are in use. Errors: kUnsupported (the display has
  /// refused one after all; there are none any more), kDeviceLost.
  virtual Result<std::optional<SurfaceId>> acquireForGpu() = 0;
  /// A copy of what the buffer of one of them holds, RGBA8 of the picture's size, or of all the
  /// buffer. Waits for the GPU; slow. Errors: kUnsupported, kDeviceLost.
  virtual Result<Image> copyOfGpuSurface(SurfaceId surface, bool isWholeBuffer) = 0;
  /// Nobody draws into them any more: what is not shown is freed, the rest as soon as it is not.
  virtual void endLending() {}

 protected:
  GpuSurfaceLender() = default;
  GpuSurfaceLender(const GpuSurfaceLender&) = default;
  GpuSurfaceLender& operator=(const GpuSurfaceLender&) = default;
};

/// Where painted pictures go: a file, a device, a display. An output takes pictures in memory
/// (MemoryOutput) or lends surfaces that are filled and handed back (SurfaceOutput). One contract
/// for all of them, held by tests/conformance/{output,surface}_conformance.h.
///
/// States: made → start() → started → finish() → finished. After an error of any call but start()'s
/// only destruction is allowed, and release() of lent surfaces; destruction is allowed in every
/// state. All calls come from one
/// thread. Time is the steady clock's.
class Output {
 public:
  virtual ~Output() = default;
  Output() = default;
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  virtual OutputIdentity identity() const = 0;

  /// Opens, and answers the format of the pictures. Called once. Errors: kPermissionDenied,
  /// kNotFound (no such folder or device), kNoSpace, kBusy, kUnsupported (size), kIo.
  virtual Result<OutputFormat> start(const OutputRequest& request) = 0;

  /// Completes and publishes. Precondition: started. Errors: kNoSpace, kIo, kDeviceLost.
  virtual Result<void> finish() = 0;

  // How it takes pictures: exactly one of these is not null. It is this object.

  virtual MemoryOutput* memory() { return nullptr; }
  virtual SurfaceOutput* surfaces() { return nullptr; }

  /// Beside that, surfaces that a GPU draws into; null: it has none. Lives as long as this object.
  virtual GpuSurfaceLender* lender() { return nullptr; }
};

/// An output that takes pictures in memory: a movie, frames, a loopback, a window.
///
/// An output to files writes under temporary names and publishes in finish(): until then, and if it
/// is destroyed without, nothing stands under the final name, and what stood there before still
/// does. A folder of frames publishes each whole frame as it comes.
class MemoryOutput : public Output {
 public:
  MemoryOutput* memory() final { return this; }

  /// Takes one picture of the format that start() answered; copies what it keeps. `time` is the
  /// capture time since the first picture's and rises strictly. Waits for as long as the output
  /// takes, but never for readers: a picture that they are too slow for is dropped and counted
  /// (skippedPictures()). Errors: kNoSpace, kIo, kDeviceLost.
  virtual Result<void> write(const ImageView& picture, Duration time) = 0;

  /// Takes a surface that was acquired for a GPU, and drawn, in place of a picture in memory, on
  /// the same terms. Precondition: lender() has lent it. Errors: those of write(); kUnsupported,
  /// where there is no lender().
  virtual Result<void> show(SurfaceId /*surface*/, Duration /*time*/) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = identity().id,
                                .problem = "takes pictures in memory only",
                                .remedy = {}});
  }

  /// Takes another stream from here on, and answers its format: of kinds that show waiting pictures
  /// (OutputTraits::showsWaiting). Errors: those of start(); kUnsupported, for other kinds.
  virtual Result<OutputFormat> reconfigure(const OutputRequest& /*request*/) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = identity().id,
                                .problem = "cannot take another stream"});
  }

  /// How many of the pictures that write() took were dropped, because their reader was too slow.
  virtual std::uint64_t skippedPictures() const { return 0; }
};

/// How a submitted surface ended.
struct PresentationEvent {
  enum class Result {
    kShown,       ///< it was on the display from `time` on
    kSuperseded,  ///< a surface that was submitted later took its refresh
    kSkipped,     ///< the display did not take it
  };
  SurfaceId surface{};
  Result result = Result::kShown;
  /// Which refresh it was, counted by the display; unset where the display does not count.
  std::optional<std::uint64_t> sequence;
  TimePoint time;  ///< of that refresh; where it was not shown, when that was known
};

/// Why an output that works shows nothing for now. It goes on by itself.
struct Suspension {
  enum class Cause {
    kConsole,  ///< another console is in front, or another program shows pictures on the display
    kBlank,    ///< the display is off: by its schedule, or because nobody is there
  };
  Cause cause = Cause::kConsole;
  std::string reason;  ///< "another console is in front"
  friend bool operator==(const Suspension&, const Suspension&) = default;
};

/// An output that lends its buffers, so that pictures reach a display without a copy in between.
///
/// A surface is free → acquire() → lent → submit() → queued → its event. It is free again once its
/// event says that it was not shown, or, where it was shown, once another has taken its place.
/// release() gives a lent one back. Every submitted surface ends in exactly one event, in the order
/// of submission, unless finish(), an error or destruction comes before. No call waits, for the
/// display, for a fence or for a free surface.
///
/// Surfaces, their ids and file descriptors belong to the output, which keeps them open from
/// start() until it is reconfigured or destroyed.
class SurfaceOutput : public Output, public GpuSurfaceLender {
 public:
  SurfaceOutput* surfaces() final { return this; }
  GpuSurfaceLender* lender() final { return this; }

  /// Takes another stream than the one that start() was asked for, such as a camera's that has come
  /// later, and answers anew as start() does. What is shown stays, unless the stream needs another
  /// mode; surfaces that are queued end as kSkipped. Surfaces are others from then on, even where
  /// their ids are the same. Precondition: started, and none is lent. Errors: as start().
  virtual Result<OutputFormat> reconfigure(const OutputRequest& request) = 0;

  /// A free surface of the format that was answered last; nothing where all are in use. Errors:
  /// kDeviceLost.
  virtual Result<std::optional<Surface>> acquire() = 0;

  /// The memory of a lent surface, for the processor, until the mapping is destroyed, which has to
  /// come before submit() and release(). Errors: kUnsupported (it cannot be mapped), kIo,
  /// kDeviceLost.
  virtual Result<SurfaceMapping> map(const Surface& surface) = 0;

  /// Takes a lent surface back unshown.
  virtual void release(const Surface& surface) = 0;

  /// Has a lent surface shown once `fence` has signalled, at the refresh nearest to `due`, or the
  /// first one after that where it is late. Errors: kDeviceLost, kIo; the surface is lent no more.
  virtual Result<void> submit(const Surface& surface, Fence fence, TimePoint due) = 0;

  /// Appends the events since the last call, oldest first. Errors: kDeviceLost, kIo.
  virtual Result<void> takeEvents(std::vector<PresentationEvent>& events) = 0;

  /// When takeEvents() will have the next one, as far as can be told; none where nothing is queued.
  virtual std::optional<TimePoint> nextEvent() const = 0;

  // Surfaces that a GPU draws into are submitted and released as the others are, and flipped among
  // them. By default there are none.

  Result<std::vector<GpuSurface>> lendToGpu(std::span<const std::uint64_t> /*modifiers*/,
                                            std::size_t /*count*/) override {
    return tl::unexpected(hasNoneForGpu());
  }
  Result<std::optional<SurfaceId>> acquireForGpu() override { return std::nullopt; }
  Result<Image> copyOfGpuSurface(SurfaceId /*surface*/, bool /*isWholeBuffer*/) override {
    return tl::unexpected(hasNoneForGpu());
  }

  /// Set while it shows nothing though it works: acquire() lends nothing, and queued surfaces have
  /// ended as kSkipped. Valid until the next call.
  virtual const Suspension* suspension() const { return nullptr; }

  /// The share of their values that pictures are to be shown with, from 0 to 1: whoever fills a
  /// surface multiplies them. It changes from call to call while a display is faded.
  virtual double brightness() const { return 1.0; }

  /// Somebody is there: a key was pressed, or something moved. A display that is off goes on.
  virtual void noteActivity() {}

 private:
  Error hasNoneForGpu() const {
    return {.kind = ErrorKind::kUnsupported,
            .subject = identity().id,
            .problem = "has no buffers for a GPU",
            .remedy = {}};
  }
};

}  // namespace pleinair::hal
