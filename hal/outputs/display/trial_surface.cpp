#include "hal/outputs/display/trial_surface.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "hal/outputs/display/display_errors.h"

namespace pleinair::hal {
namespace {

using namespace display;

/// No whole number of tiles of any layout.
constexpr FrameSize kSize{300, 70};

/// The layouts that a primary plane of the card takes.
std::vector<std::uint64_t> planeModifiers(const CardState& state) {
  const auto primary = std::ranges::find(state.planes, true, &Plane::isPrimary);
  if (primary == state.planes.end() || primary->modifiers.empty()) return {kLinearModifier};
  return primary->modifiers;
}

Result<GpuBuffer> makeBuffer(Card& card, std::span<const std::uint64_t> modifiers) {
  const Result<CardState> state = card.read(false);
  if (!state) return tl::unexpected(state.error());
  const std::vector<std::uint64_t> taken = planeModifiers(*state);
  std::vector<std::uint64_t> common;
  std::ranges::copy_if(modifiers, std::back_inserter(common), [&](std::uint64_t each) {
    return std::ranges::find(taken, each) != taken.end();
  });
  if (common.empty()) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = card.node(),
                                .problem = "takes none of the layouts that the GPU draws",
                                .remedy = {}});
  }
  GpuBuffer buffer;
  const int failed = card.createGpuBuffer(kSize, common, buffer);
  if (failed == 0) return buffer;
  Error error = errnoError(card.node(), "cannot make a buffer for the GPU", -failed);
  if (error.kind != ErrorKind::kNoSpace) error.kind = ErrorKind::kUnsupported;
  return tl::unexpected(std::move(error));
}

}  // namespace

Result<std::unique_ptr<TrialSurface>> TrialSurface::make(const std::string& target,
                                                         std::span<const std::uint64_t> modifiers,
                                                         Cards& cards) {
  const DisplayName name = parseDisplayName(target);
  std::optional<Error> problem;
  for (const std::string& node : cards.nodes()) {
    if (!name.isOn(node)) continue;
    Result<std::shared_ptr<SharedCard>> card = SharedCard::of(cards, node);
    Result<GpuBuffer> buffer = card ? makeBuffer((*card)->card(), modifiers)
                                    : Result<GpuBuffer>(tl::unexpected(card.error()));
    if (buffer) return std::make_unique<TrialSurface>(*std::move(card), *buffer);
    if (!problem) problem = std::move(buffer.error());
  }
  return tl::unexpected(problem ? *std::move(problem) : noCard(target));
}

TrialSurface::TrialSurface(std::shared_ptr<SharedCard> card, const GpuBuffer& buffer)
    : card_(std::move(card)), buffer_(buffer) {}

TrialSurface::~TrialSurface() {
  card_->card().destroyGpuBuffer(buffer_);
}

GpuSurface TrialSurface::surface() const {
  GpuSurface surface{.surface = {}, .bufferSize = kSize};
  surface.surface.format = {.pixelFormat = PixelFormat::kRgba8, .size = kSize, .encoding = {}};
  surface.surface.modifier = buffer_.modifier;
  surface.surface.planeCount = buffer_.planeCount;
  surface.surface.planes = buffer_.planes;
  return surface;
}

Result<Image> TrialSurface::copy() {
  Image image({.pixelFormat = PixelFormat::kRgba8, .size = kSize, .encoding = {}});
  const std::span<std::uint8_t> pixels = image.plane(0);
  if (const int failed = card_->card().readGpuBuffer(buffer_, kSize, pixels); failed != 0) {
    Error error = errnoError(card_->card().node(), "cannot read back what the GPU drew", -failed);
    error.kind = ErrorKind::kUnsupported;
    return tl::unexpected(std::move(error));
  }
  for (std::size_t i = 0; i + 4 <= pixels.size(); i += 4) std::swap(pixels[i], pixels[i + 2]);
  return image;
}

}  // namespace pleinair::hal
