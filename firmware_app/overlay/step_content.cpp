#include "firmware_app/overlay/step_content.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "firmware_app/overlay/doubt_words.h"
#include "firmware_app/overlay/instruction_panel.h"
#include "firmware_app/overlay/model_picture.h"
#include "firmware_app/overlay/step_movie.h"
#include "firmware_app/procedure/step_arrows.h"
#include "firmware_app/procedure/step_ghosts.h"
#include "pipeline/procedure/notices.h"
#include "pipeline/procedure/words.h"

namespace pleinair::app {
namespace {

using overlay::ArrowKind;
using overlay::OverlayContent;
using overlay::PartLook;
using procedure::Step;

constexpr double kInsetShare = 0.36;  // of the output's width

hal::FrameSize insetSize(int outputWidth) {
  const int width = std::max(1, static_cast<int>(kInsetShare * outputWidth));
  return {width, std::max(1, 3 * width / 4)};
}

PartLook lookOf(procedure::PartView view) {
  switch (view) {
    case procedure::PartView::kPlain:
      return PartLook::kPlain;
    case procedure::PartView::kFocus:
      return PartLook::kFocus;
    case procedure::PartView::kTint:
      return PartLook::kTint;
    case procedure::PartView::kOutline:
      return PartLook::kOutline;
    case procedure::PartView::kHidden:
    case procedure::PartView::kGhost:
      return PartLook::kHidden;
  }
  return PartLook::kPlain;
}

void addParts(const StepShown& shown, const scene::Model& machine, OverlayContent& content) {
  content.looks.assign(machine.parts.size(), PartLook::kPlain);
  for (const std::size_t part : shown.partsOff) content.looks[part] = PartLook::kHidden;
  if (shown.step == procedure::kEnd) return;
  const Step& step = shown.procedure->steps[shown.step];
  for (const std::size_t part : step.parts) {
    if (content.looks[part] != PartLook::kHidden) content.looks[part] = PartLook::kFocus;
  }
  for (const auto& [part, view] : step.views) content.looks[part] = lookOf(view);
  content.ghosts = ghostsOf(step, machine, shown.procedure->unitMetres);
  content.arrows = arrowsOf(step, machine);
}

void addLabel(const StepShown& shown, int width, OverlayContent& content) {
  if (shown.step == procedure::kEnd) return;
  const Step& step = shown.procedure->steps[shown.step];
  if (step.parts.empty()) return;
  // How many screws there are; of other things the count says little.
  const bool isScrewed = std::ranges::all_of(content.arrows, [](const overlay::Arrow& each) {
    return each.kind == ArrowKind::kScrew || each.kind == ArrowKind::kUnscrew;
  });
  const std::size_t moved = isScrewed ? content.arrows.size() : 0;
  std::string text;
  if (moved > 1 && moved < kMostArrows) text = fmt::format("×{}", moved);
  if (step.torque) {
    text += (text.empty() ? "" : "  ") + procedure::withDecimals(step.torque->text, shown.language);
  }
  content.labels.push_back(
      {.picture = stepMarker(fmt::format("{}", shown.step + 1), text, width), .parts = step.parts});
}

}  // namespace

OverlayContent stepContent(const StepShown& shown, const scene::Model& machine,
                           const std::filesystem::path& folder, hal::FrameSize output,
                           hal::Image inset) {
  OverlayContent content;
  addParts(shown, machine, content);
  addLabel(shown, output.width, content);
  InstructionPanel panel = instructionPanel(shown, folder, output);
  content.panel = std::move(panel.image);
  content.moviePlace = panel.movie.value_or(overlay::MoviePlace{});
  content.inset = std::move(inset);
  for (std::size_t i = 0; i < overlay::kDoubts; ++i) {
    const std::string text(wordsOf(static_cast<overlay::Doubt>(i), shown.language));
    if (!text.empty()) content.badges.at(i) = doubtBadge(text, output.width);
  }
  return content;
}

hal::Image stepInset(const StepShown& shown, const scene::Model& machine, int outputWidth) {
  OverlayContent content;
  addParts(shown, machine, content);
  std::span<const std::size_t> parts;
  if (shown.step != procedure::kEnd) parts = shown.procedure->steps[shown.step].parts;
  return modelPicture(
      machine,
      {.looks = content.looks, .ghosts = content.ghosts, .arrows = content.arrows, .parts = parts},
      insetSize(outputWidth), shown.procedure->uprightFromModel);
}

std::shared_ptr<const overlay::PanelMovie> stepMovie(const StepShown& shown,
                                                     const std::filesystem::path& folder,
                                                     const overlay::MoviePlace& place,
                                                     const std::stop_token& stop) {
  if (place.size.width == 0) return nullptr;
  auto movie =
      readStepMovie(folder / shown.procedure->steps[shown.step].movie->file, place.size, stop);
  if (movie) return *std::move(movie);
  spdlog::warn("step {}: {}", shown.procedure->steps[shown.step].id, movie.error().message());
  return textMovie(std::string(procedure::noticesIn(shown.language).movieUnreadable), place.size);
}

hal::Image blankInset(int outputWidth) {
  return hal::Image({.pixelFormat = hal::PixelFormat::kRgba8, .size = insetSize(outputWidth)});
}

}  // namespace pleinair::app
