#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/file_descriptor.h"
#include "hal/output.h"
#include "hal/surface.h"

namespace pleinair::runtime {

/// Surfaces that an output lends to the painter. Their descriptors are the loan's own: they stay
/// open while it is kept, whatever becomes of the output.
struct SurfaceLoan {
  std::uint64_t number = 0;  ///< hal::LentSurface::loan
  std::vector<hal::GpuSurface> surfaces;
  std::vector<hal::FileDescriptor> descriptors;
};

/// What a painter draws into: layouts of memory with descriptors (modifiers of drm_fourcc.h, for
/// XRGB8888), and textures that are shared on one EGLDisplay.
struct DrawableLayouts {
  std::vector<std::uint64_t> modifiers;
  std::string problem;            ///< why there are none
  void* eglDisplay = nullptr;     ///< null: no textures
  std::string apartBecause = {};  ///< why it is not another's, if that is known
};

/// How pictures reach the memory that a display scans out, or a window, and why so.
struct ScanOut {
  enum class Path {
    kUnknown,  ///< not an output that lends surfaces to a GPU, or not found out yet
    kCopied,   ///< read back from the GPU, and copied by the processor
    kDirect,   ///< the GPU draws into it, or into a texture that a window is drawn from
  };
  Path path = Path::kUnknown;
  std::string reason;          ///< of kCopied; of kDirect, the layout
  hal::Duration took{0};       ///< the trial
  std::uint64_t surfaces = 0;  ///< lent
  std::uint64_t direct = 0;    ///< frames that were handed over without a copy
};

/// The hand-over of surfaces between an output and the painter, which draws into them. A trial
/// decides whether it may: the output makes surfaces, the painter draws a pattern into each, and
/// the output compares what lies in its memory; the contract of an image that is shared promises
/// less than that. Where any step fails, frames are copied as before. Allocates in trials only.
class SurfaceLending {
 public:
  /// The clock outlives it.
  explicit SurfaceLending(const hal::Clock& clock) : clock_(clock) {}

  // Paint thread.

  /// A painter is there, which draws into surfaces of these layouts: a trial begins.
  void offer(DrawableLayouts layouts);
  /// The loan into whose surfaces the pattern is to be drawn; null where there is none.
  std::shared_ptr<const SurfaceLoan> toImport() const;
  /// The pattern was drawn into all surfaces of a loan, or why not.
  void imported(std::uint64_t loan, const hal::Result<void>& drawn);
  /// A surface for the next frame; nothing where none is free, or the trial is not over.
  std::optional<hal::LentSurface> take();

  // Output thread.

  /// Goes on with the trial, of `count` surfaces, and keeps them ready. `name`: of the output, in
  /// messages. `comparisons`: how many surfaces are compared at a time, each of which may take some
  /// 10 ms. Errors: kDeviceLost.
  hal::Result<void> step(hal::GpuSurfaceLender& lender, const std::string& name, std::size_t count,
                         std::size_t comparisons);
  /// The output has gone, or shows another stream: nothing that was lent is valid any more. A trial
  /// begins again at the next step().
  void restart();

  // Both.

  /// A surface that was drawn into, or was to be, is not shown.
  void giveBack(const hal::LentSurface& surface);
  /// Whether its output still has it.
  bool isCurrent(const hal::LentSurface& surface) const;

  // Any thread.

  void countDirect();
  ScanOut status() const;

 private:
  enum class State { kIdle, kOffered, kLent, kDrawn, kInUse, kRefused };

  hal::Result<void> checkOffer(hal::GpuSurfaceLender& lender, const std::string& name) const;
  hal::Result<void> lend(hal::GpuSurfaceLender& lender, const std::string& name, std::size_t count);
  hal::Result<void> compare(hal::GpuSurfaceLender& lender, std::size_t comparisons);
  hal::Result<void> keepReady(hal::GpuSurfaceLender& lender);
  void refuse(const hal::Error& error);

  const hal::Clock& clock_;
  mutable std::mutex mutex_;  // guards the members below
  State state_ = State::kIdle;
  bool isToEnd_ = false;  // the lender does not know yet that its surfaces were refused
  DrawableLayouts layouts_;
  std::shared_ptr<const SurfaceLoan> loan_;
  std::uint64_t loans_ = 0;
  std::size_t compared_ = 0;           ///< of the loan's surfaces
  std::vector<hal::SurfaceId> ready_;  ///< acquired, for take()
  hal::TimePoint began_;
  ScanOut status_;
};

}  // namespace pleinair::runtime
