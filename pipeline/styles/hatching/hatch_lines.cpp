#include "pipeline/styles/hatching/hatch_lines.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pipeline/marks/fading_past.h"

namespace pleinair::styles {
namespace {

const std::string kShaders = "pipeline/styles/hatching/shaders/";
constexpr int kArm = 8;             // shaders/line.glsl
constexpr int kShiftColumns = 128;  // shaders/line_shift.glsl
/// Lines that far apart, in spacings, are kept in step.
constexpr double kReachSpacings = 5.0;
constexpr double kAlignSeconds = 6.0;
/// Before a camera that stands, lines of the background are held so much longer: what passes beside
/// them must not turn them.
constexpr double kStandingHold = 100.0;
/// Time constants on movers: of a line's shape, since theirs changes with every step, and of its
/// place among its neighbours, which has to look even only.
constexpr double kMoverShapeSeconds = 0.15;
constexpr double kMoverAlignSeconds = 1.0;
/// The longest in which a line of a mover that is too many goes.
constexpr hal::Duration kMoverFade = std::chrono::milliseconds(450);
/// Displacements (marks::MotionLayers) over which lines of a mover in place leave its field for the
/// slope, of the picture's longer side: 9 to 21 px of 640, about 22 to 52 px a second.
constexpr glm::vec2 kGoes{9.0F / 640.0F, 21.0F / 640.0F};
/// Of a first frame, from random places.
constexpr int kFirstSteps = 24;
constexpr float kFirstPast = 0.3F;

gpu::Texture shiftsOf(std::uint32_t slots) {
  const int rows = (static_cast<int>(slots) + kShiftColumns - 1) / kShiftColumns;
  return {gpu::TextureFormat::kRgba32f, {kShiftColumns, rows}};
}

int cellOf(const HatchPlan& plan) {
  constexpr double kAnchorsOfCell = 2.0;  // marks::DensityRule::target
  const double area = plan.spacingPx * plan.lengthPx / plan.coverage;
  return std::max(4, static_cast<int>(std::lround(std::sqrt(kAnchorsOfCell * area))));
}

/// The past's shares (shaders/line_past.glsl).
glm::vec3 pastOf(hal::Duration step, double seconds, double moverSeconds,
                 const marks::MotionLayers* movers) {
  const bool isStanding = movers != nullptr && movers->hasStood();
  return {marks::keptAfter(step, seconds),
          marks::keptAfter(step, isStanding ? kStandingHold * seconds : seconds),
          marks::keptAfter(step, std::min(seconds, moverSeconds))};
}

}  // namespace

void bindHatchTone(gpu::Program& program, const scene::ArFrame& frame, const gpu::Texture& tone,
                   const HatchRule& rule) {
  program.texture("tone", tone)
      .set("fullSize", glm::vec2(frame.full().width, frame.full().height))
      .set("isInverted", rule.isInverted ? 1 : 0)
      .set("darkness", rule.darkness)
      .set("gamma", rule.gamma)
      .set("band", rule.band)
      .set("swell", rule.swell)
      .set("width", rule.widthPx);
  rule.fidelity.bind(program);
}

HatchLines::HatchLines(const gpu::ShaderLibrary& library, hal::FrameSize full,
                       const HatchPlan& plan)
    : plan_(plan),
      anchors_(library, full, {.density = {.cellPixels = cellOf(plan)}, .seed = plan.seed}),
      slots_(anchors_.slotCount()),
      segmentPx_(static_cast<float>(plan.lengthPx / (2 * kArm))),
      points_(library.compute(kShaders + "line_points.comp")),
      align_(library.compute(kShaders + "line_align.comp")),
      trace_(library.compute(kShaders + "line_trace.comp")),
      order_(library.compute(kShaders + "line_order.comp")),
      lay_(library.compute(kShaders + "line_instances.comp")),
      stripMaker_(library, StrokeForm::kLong),
      bins_(library),
      binned_(slots_ * sizeof(marks::BinnedPoint), gpu::BufferUsage::kDynamic),
      shifts_{shiftsOf(slots_), shiftsOf(slots_)},
      lines_(slots_ * kLineBytes, gpu::BufferUsage::kDynamic),
      ranks_(slots_ * sizeof(std::uint32_t), gpu::BufferUsage::kDynamic),
      command_(gpu::kDrawCommandBytes, gpu::BufferUsage::kDynamic),
      instances_(slots_ * instanceBytesOf(StrokeForm::kLong), gpu::BufferUsage::kDynamic),
      noIds_(gpu::TextureFormat::kR32ui, {1, 1}) {
  const int bin = std::max(8, static_cast<int>(std::lround(kReachSpacings * plan.spacingPx)));
  bins_.allocate({std::max(1, full.width / bin), std::max(1, full.height / bin)}, slots_);
  lines_.write(std::vector<std::byte>(lines_.sizeBytes()));
}

void HatchLines::update(const scene::ArFrame& frame, const Inputs& inputs, const HatchRule& rule) {
  const hal::Duration step = marks::timeStep(lastTime_, frame.captureTime);
  lastTime_ = frame.captureTime;
  // Lines that a mover carries gather on one side of it; each that is too many is seen.
  const marks::AnchorHold hold{.fadeIn = rule.fade,
                               .fadeOut = rule.fade,
                               .moverFadeOut = kMoverFade,
                               .hasMoverSlack = false};
  anchors_.advance(frame, *inputs.motion, hold, inputs.movers, inputs.field);
  align(frame, inputs, rule, step);
  trace(frame, inputs, rule, step);
  layOut(frame, inputs, rule);
}

void HatchLines::bindField(gpu::Program& program, const scene::ArFrame& frame, const Inputs& inputs,
                           const HatchRule& rule, std::size_t level) const {
  const marks::TensorField& field = *inputs.field;
  const gpu::Texture& displacements = layerTextures_.displacementsOf(inputs.movers);
  constexpr float kBlockPx = marks::MotionLayers::kBlockCells * marks::MotionLayers::kCellPixels;
  const auto side = static_cast<float>(std::max(frame.full().width, frame.full().height));
  program.texture("field", field.resolved(level))
      .texture("modelField", field.resolvedModels(level))
      .texture("moverField", field.movers())
      .texture("displacements", displacements)
      .set("fieldScale", field.textureScale(level))
      .set("moverScale", field.textureScale(0))
      .set("blockScale", glm::vec2(1.0F / kBlockPx))
      .set("goes", side * kGoes)
      .set("slope", rule.slope)
      .set("lead", rule.lead)
      .set("turn", glm::vec2(std::cos(rule.turnRad), std::sin(rule.turnRad)));
}

void HatchLines::bindSupport(gpu::Program& program, const scene::ArFrame& frame,
                             const marks::MotionLayers* movers) const {
  program.texture("movers", layerTextures_.labelsOf(movers))
      .texture("ids", frame.hasObjects ? *frame.ids : noIds_)
      .texture("forms", frame.hasObjects ? *frame.forms : noIds_)
      .set("hasObjects", frame.hasObjects ? 1 : 0)
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()));
}

void HatchLines::align(const scene::ArFrame& frame, const Inputs& inputs, const HatchRule& rule,
                       hal::Duration step) {
  points_.use()
      .storage("Anchors", anchors_.anchors())
      .storage("Points", binned_)
      .storage("Lines", lines_)
      .set("slots", slots_)
      .set("anew", anchors_.hasBegunAnew() ? 1 : 0);
  bindSupport(points_, frame, inputs.movers);
  points_.dispatch({static_cast<int>(slots_), 1}, GL_SHADER_STORAGE_BARRIER_BIT);
  bins_.sort(binned_, frame.full());
  const bool isAnew = anchors_.hasBegunAnew();
  const int steps = isAnew ? kFirstSteps : 1;
  const std::size_t level = std::min(rule.fieldLevel, inputs.field->levelCount() - 1);
  for (int i = 0; i < steps; ++i) {
    align_.use()
        .storage("Anchors", anchors_.anchors())
        .storage("Starts", bins_.starts())
        .storage("Sorted", bins_.sorted())
        .storage("Lines", lines_)
        .texture("before", shifts_[latest_])
        .image("shifts", shifts_[1 - latest_], gpu::ImageAccess::kWrite)
        .set("bins", bins_.bins())
        .set("binPixels", bins_.binPixels(frame.full()))
        .set("slots", slots_)
        .set("anew", isAnew && i == 0 ? 1 : 0)
        .set("isFirst", isAnew ? 1 : 0)
        .set("spacing", static_cast<float>(plan_.spacingPx))
        .set("reach", static_cast<float>(kReachSpacings * plan_.spacingPx))
        .set("past", isAnew ? glm::vec3(kFirstPast)
                            : pastOf(step, kAlignSeconds, kMoverAlignSeconds, inputs.movers));
    bindField(align_, frame, inputs, rule, level);
    align_.dispatch({static_cast<int>(slots_), 1},
                    GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    latest_ = 1 - latest_;
  }
}

void HatchLines::trace(const scene::ArFrame& frame, const Inputs& inputs, const HatchRule& rule,
                       hal::Duration step) {
  const marks::TensorField& field = *inputs.field;
  const std::size_t level = std::min(rule.fieldLevel, field.levelCount() - 1);
  trace_.use()
      .storage("Anchors", anchors_.anchors())
      .storage("Lines", lines_)
      .texture("shifts", shifts_[latest_])
      .set("slots", slots_)
      .set("anew", anchors_.hasBegunAnew() ? 1 : 0)
      .set("cellPixels", static_cast<float>(anchors_.options().density.cellPixels))
      .set("segment", segmentPx_)
      .set("steps", static_cast<float>(kArm))
      .set("arms", glm::ivec2(2, kArm))
      .set("cutOff", std::cos(rule.cutOffRad))
      .set("wander", rule.wanderRad)
      .set("jitter", (1.0F - rule.evenness) * 0.5F * static_cast<float>(plan_.spacingPx))
      .set("past",
           pastOf(step, hal::toSeconds(rule.shapeMemory), kMoverShapeSeconds, inputs.movers));
  bindSupport(trace_, frame, inputs.movers);
  bindField(trace_, frame, inputs, rule, level);
  bindHatchTone(trace_, frame, *inputs.tone, rule);
  trace_.dispatch({static_cast<int>(slots_), 1}, GL_SHADER_STORAGE_BARRIER_BIT);
}

void HatchLines::layOut(const scene::ArFrame& frame, const Inputs& inputs, const HatchRule& rule) {
  order_.use()
      .storage("Lines", lines_)
      .storage("Ranks", ranks_)
      .storage("Command", command_)
      .set("slots", slots_)
      .dispatch({1, 1}, GL_SHADER_STORAGE_BARRIER_BIT);
  lay_.use()
      .storage("Anchors", anchors_.anchors())
      .storage("Lines", lines_)
      .storage("Ranks", ranks_)
      .storage("Instances", instances_)
      .set("slots", slots_)
      .set("segment", segmentPx_)
      .set("taper", rule.taper)
      .set("points", 2 * kArm)
      .set("paint", rule.paint)
      .set("rankColour", rule.rankColour)
      .texture("colours", inputs.colours != nullptr ? *inputs.colours : *frame.colour)
      .texture("movers", layerTextures_.labelsOf(inputs.movers))
      .texture("background", layerTextures_.backgroundOf(inputs.movers))
      .set("colour", rule.colour);
  bindHatchTone(lay_, frame, *inputs.tone, rule);
  lay_.dispatch({static_cast<int>(slots_), 1}, GL_SHADER_STORAGE_BARRIER_BIT);
  StripClipping clipping{.clips = frame.hasObjects || inputs.movers != nullptr};
  if (!frame.hasObjects && inputs.movers != nullptr) {
    clipping.onlyMovers = inputs.movers->busyBlocks();
  }
  stripMaker_.lay(instances_, command_, StrokeQuads::kCurvature, strips_, clipping);
}

}  // namespace pleinair::styles
