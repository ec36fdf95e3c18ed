#include "pipeline/runtime/output/surface_lending.h"

#include <algorithm>
#include <utility>

#include <fcntl.h>

#include "hal/surface_pattern.h"

namespace pleinair::runtime {
namespace {

/// Gives the loan's surfaces descriptors that the loan owns.
bool ownDescriptors(SurfaceLoan& loan) {
  for (hal::GpuSurface& each : loan.surfaces) {
    for (int i = 0; i < each.surface.planeCount; ++i) {
      hal::SurfacePlane& plane = each.surface.planes.at(static_cast<std::size_t>(i));
      hal::FileDescriptor own(::fcntl(plane.dmaBuf, F_DUPFD_CLOEXEC, 0));
      if (!own) return false;
      plane.dmaBuf = own.get();
      loan.descriptors.push_back(std::move(own));
    }
  }
  return true;
}

}  // namespace

void SurfaceLending::offer(DrawableLayouts layouts) {
  const std::scoped_lock lock(mutex_);
  layouts_ = std::move(layouts);
  loan_.reset();
  ready_.clear();
  state_ = State::kOffered;
}

void SurfaceLending::restart() {
  const std::scoped_lock lock(mutex_);
  loan_.reset();
  ready_.clear();
  if (state_ != State::kIdle) state_ = State::kOffered;
}

std::shared_ptr<const SurfaceLoan> SurfaceLending::toImport() const {
  const std::scoped_lock lock(mutex_);
  return state_ == State::kLent ? loan_ : nullptr;
}

void SurfaceLending::imported(std::uint64_t loan, const hal::Result<void>& drawn) {
  const std::scoped_lock lock(mutex_);
  if (state_ != State::kLent || loan_->number != loan) return;
  if (drawn) {
    state_ = State::kDrawn;
  } else {
    refuse(drawn.error());
  }
}

std::optional<hal::LentSurface> SurfaceLending::take() {
  const std::scoped_lock lock(mutex_);
  if (state_ != State::kInUse || ready_.empty()) return std::nullopt;
  const hal::SurfaceId taken = ready_.back();
  ready_.pop_back();
  return hal::LentSurface{.loan = loan_->number, .id = taken};
}

void SurfaceLending::giveBack(const hal::LentSurface& surface) {
  const std::scoped_lock lock(mutex_);
  if (state_ == State::kInUse && loan_->number == surface.loan) ready_.push_back(surface.id);
}

bool SurfaceLending::isCurrent(const hal::LentSurface& surface) const {
  const std::scoped_lock lock(mutex_);
  return state_ == State::kInUse && loan_->number == surface.loan;
}

hal::Result<void> SurfaceLending::step(hal::GpuSurfaceLender& lender, const std::string& name,
                                       std::size_t count, std::size_t comparisons) {
  State state{};
  bool isToEnd = false;
  {
    const std::scoped_lock lock(mutex_);
    state = state_;
    isToEnd = std::exchange(isToEnd_, false);
  }
  if (isToEnd) lender.endLending();
  if (state == State::kOffered) return lend(lender, name, count);
  if (state == State::kDrawn) return compare(lender, comparisons);
  if (state == State::kInUse) return keepReady(lender);
  return {};
}

/// Precondition: the mutex is held.
void SurfaceLending::refuse(const hal::Error& error) {
  state_ = State::kRefused;
  isToEnd_ = loan_ != nullptr;
  loan_.reset();
  ready_.clear();
  status_.path = ScanOut::Path::kCopied;
  status_.reason = error.message();
  status_.surfaces = 0;
  status_.took = clock_.now() - began_;
}

/// Whether the painter can draw into surfaces of this kind. Precondition: the mutex is held.
hal::Result<void> SurfaceLending::checkOffer(hal::GpuSurfaceLender& lender,
                                             const std::string& name) const {
  const hal::Result<void*> display = lender.eglDisplay();
  if (!display) return tl::unexpected(display.error());
  hal::Error error{
      .kind = hal::ErrorKind::kUnsupported, .subject = "GPU", .problem = {}, .remedy = {}};
  if (*display == nullptr) {
    if (!layouts_.modifiers.empty()) return {};
    error.problem = layouts_.problem;
  } else {
    if (*display == layouts_.eglDisplay) return {};
    error.problem =
        layouts_.apartBecause.empty() ? "shares no textures with " + name : layouts_.apartBecause;
  }
  return tl::unexpected(std::move(error));
}

hal::Result<void> SurfaceLending::lend(hal::GpuSurfaceLender& lender, const std::string& name,
                                       std::size_t count) {
  std::vector<std::uint64_t> modifiers;
  {
    const std::scoped_lock lock(mutex_);
    began_ = clock_.now();
    if (auto offered = checkOffer(lender, name); !offered) {
      refuse(offered.error());
      return {};
    }
    modifiers = layouts_.modifiers;
  }
  hal::Result<std::vector<hal::GpuSurface>> lent = lender.lendToGpu(modifiers, count);
  const std::scoped_lock lock(mutex_);
  if (!lent) {
    refuse(lent.error());
    const bool isGone = lent.error().kind == hal::ErrorKind::kDeviceLost;
    return isGone ? hal::Result<void>(tl::unexpected(lent.error())) : hal::Result<void>();
  }
  auto loan = std::make_shared<SurfaceLoan>();
  loan->number = ++loans_;
  loan->surfaces = *std::move(lent);
  if (!ownDescriptors(*loan)) {
    refuse({.kind = hal::ErrorKind::kUnsupported,
            .subject = name,
            .problem = "has buffers that cannot be shared with the GPU",
            .remedy = {}});
    return {};
  }
  if (state_ != State::kOffered) return {};
  ready_.reserve(2 * count);
  loan_ = std::move(loan);
  compared_ = 0;
  state_ = State::kLent;
  return {};
}

/// Looks at what the painter has drawn, from the output's side.
hal::Result<void> SurfaceLending::compare(hal::GpuSurfaceLender& lender, std::size_t comparisons) {
  std::shared_ptr<const SurfaceLoan> loan;
  {
    const std::scoped_lock lock(mutex_);
    loan = loan_;
  }
  if (!loan) return {};  // another painter has come meanwhile
  std::optional<hal::Error> wrong;
  const std::size_t end = std::min(compared_ + comparisons, loan->surfaces.size());
  for (; compared_ < end && !wrong; ++compared_) {
    const hal::SurfaceId surface = loan->surfaces[compared_].surface.id;
    const hal::Result<hal::Image> seen = lender.copyOfGpuSurface(surface, true);
    if (!seen) {
      wrong = seen.error();
    } else if (auto same = hal::checkSurfacePattern(seen->view(), surface); !same) {
      wrong = same.error();
    }
  }
  const std::scoped_lock lock(mutex_);
  if (state_ != State::kDrawn || loan_ != loan) return {};
  if (wrong) {
    refuse(*wrong);
    if (wrong->kind == hal::ErrorKind::kDeviceLost) return tl::unexpected(*wrong);
    return {};
  }
  if (compared_ < loan->surfaces.size()) return {};
  state_ = State::kInUse;
  status_.path = ScanOut::Path::kDirect;
  const hal::GpuSurface& first = loan->surfaces.front();
  status_.reason =
      first.texture.image ? "shared textures" : hal::layoutText(first.surface.modifier);
  status_.surfaces = loan->surfaces.size();
  status_.took = clock_.now() - began_;
  return {};
}

hal::Result<void> SurfaceLending::keepReady(hal::GpuSurfaceLender& lender) {
  for (;;) {
    const hal::Result<std::optional<hal::SurfaceId>> free = lender.acquireForGpu();
    const std::scoped_lock lock(mutex_);
    if (!free) {
      if (state_ == State::kInUse) refuse(free.error());
      if (free.error().kind == hal::ErrorKind::kUnsupported) return {};
      return tl::unexpected(free.error());
    }
    if (!*free || state_ != State::kInUse) return {};
    ready_.push_back(**free);
  }
}

void SurfaceLending::countDirect() {
  const std::scoped_lock lock(mutex_);
  ++status_.direct;
}

ScanOut SurfaceLending::status() const {
  const std::scoped_lock lock(mutex_);
  return status_;
}

}  // namespace pleinair::runtime
