#include "pipeline/overlay/overlay_renderer.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <utility>

#include <glm/common.hpp>

namespace pleinair::overlay {
namespace {

using namespace std::chrono_literals;

constexpr int kLookColumns = 1024;  // as shaders/region.frag has it
constexpr double kUsualWidth = 640.0;
constexpr double kOverlayMarginPx = 8.0;
constexpr hal::Duration kPanelBadFor = 600ms;

bool isMarked(PartLook look) {
  return look == PartLook::kFocus || look == PartLook::kTint || look == PartLook::kOutline;
}

double eased(double t) {
  return t * t * (3.0 - 2.0 * t);
}

glm::dvec2 sizeOf(const Sprite& sprite) {
  return {sprite.size().width, sprite.size().height};
}

}  // namespace

OverlayRenderer::OverlayRenderer(const gpu::ShaderLibrary& library, const scene::Scene& scene,
                                 std::optional<std::size_t> machine, hal::FrameSize output,
                                 std::shared_ptr<DoubtfulTags> doubtfulTags)
    : scene_(scene),
      machine_(machine),
      size_(output),
      pxScale_(static_cast<float>(std::max(0.5, output.width / kUsualWidth))),
      copy_(library.fragmentPass("pipeline/overlay/shaders/copy.frag")),
      region_(library.fragmentPass("pipeline/overlay/shaders/region.frag")),
      marks_(library.fragmentPass("pipeline/overlay/shaders/marks.frag")),
      output_(gpu::TextureFormat::kRgba8, output, gpu::TextureFilter::kLinear),
      regionTexture_(gpu::TextureFormat::kR8, output),
      target_({&output_}),
      regionTarget_({&regionTexture_}),
      figures_(library, output),
      drawing_(library) {
  if (!machine_) return;
  assert(*machine_ < scene.models.size());
  for (std::size_t i = 0; i < model().parts.size(); ++i) shapes_.push_back(shapeOf(model(), i));
  boxes_.resize(shapes_.size());
  hidden_.resize(shapes_.size());
  contradictions_.emplace(scene, *machine_, std::move(doubtfulTags));
}

void OverlayRenderer::reset() {
  other_.reset();
  trust_.reset();
  layout_.reset();
  panelBadSince_.reset();
}

bool OverlayRenderer::take(const std::shared_ptr<const OverlayContent>& content) {
  if (content == content_) return false;
  const bool isSameStep =
      content && content_ && content->looks == content_->looks &&
      content->ghosts == content_->ghosts && content->arrows == content_->arrows &&
      std::ranges::equal(content->labels, content_->labels, {}, &Label::parts, &Label::parts);
  content_ = content;
  movie_.take(content_ ? content_->movie : nullptr);
  std::ranges::fill(hidden_, std::uint8_t{0});
  if (!content_) return true;
  assert(!machine_ || content_->looks.empty() || content_->looks.size() == shapes_.size());
  panel_ = Sprite(content_->panel);
  inset_ = Sprite(content_->inset);
  for (std::size_t i = 0; i < kDoubts; ++i) badges_.at(i) = Sprite(content_->badges.at(i));
  labelSprites_.clear();
  for (const Label& label : content_->labels) labelSprites_.emplace_back(label.picture);
  targets_.resize(labelSprites_.size());
  keepClear_.reserve(3 + content_->arrows.size());
  if (machine_) takeLooks();
  if (isSameStep) return true;  // another text: a digit that was typed
  if (machine_) figures_.take(model(), *content_);
  layout_.reset();
  began_.reset();
  return true;
}

void OverlayRenderer::takeLooks() {
  focus_.clear();
  const int rows =
      std::max(1, static_cast<int>((model().triangleCount() + kLookColumns - 1) / kLookColumns));
  std::vector<std::uint8_t> looks(static_cast<std::size_t>(rows) * kLookColumns);
  for (std::size_t i = 0; i < content_->looks.size(); ++i) {
    const PartLook look = content_->looks[i];
    hidden_[i] = look == PartLook::kHidden ? 1 : 0;
    if (!isMarked(look)) continue;
    focus_.push_back(i);
    const scene::ModelPart& part = model().parts[i];
    std::fill_n(looks.begin() + part.firstTriangle, part.triangleCount,
                static_cast<std::uint8_t>(look));
  }
  if (lookTexture_.size() != hal::FrameSize{kLookColumns, rows}) {
    lookTexture_ = gpu::Texture(gpu::TextureFormat::kR8, {kLookColumns, rows});
  }
  lookTexture_.upload(looks, kLookColumns);
}

void OverlayRenderer::findBoxes(const OverlayFrame& frame) {
  std::ranges::fill(boxes_, std::nullopt);
  marked_.reset();
  ghosts_.reset();
  if (!frame.machine) return;
  const glm::dmat4& cameraFromModel = frame.machine->cameraFromBody;
  const auto take = [&](std::size_t part, const glm::dvec3& apart) {
    PartShape shape = shapes_[part];
    const auto box = boxOf(shape, cameraFromModel, *frame.camera);
    boxes_[part] = box;
    if (!box) return;
    marked_ = marked_ ? boxAround(*marked_, *box) : *box;
    if (apart == glm::dvec3(0.0)) return;
    for (glm::dvec3& corner : shape.corners) corner += apart;
    if (const auto away = boxOf(shape, cameraFromModel, *frame.camera)) {
      marked_ = boxAround(*marked_, *away);
      ghosts_ = ghosts_ ? boxAround(*ghosts_, *away) : *away;
    }
  };
  for (const std::size_t part : focus_) take(part, glm::dvec3(0.0));
  for (const Ghost& ghost : content_->ghosts) take(ghost.part, ghost.apartMetres);
}

/// Command cards are shown by hands, and stand on no machine.
bool OverlayRenderer::seesOtherMachine(const OverlayFrame& frame) {
  std::array<int, OtherMachine::kMostNeighbours> unknown{};
  std::size_t count = 0;
  for (const int id : frame.unknownTags) {
    const bool isCard = std::ranges::find(content_->cards, id) != content_->cards.end();
    if (!isCard && count < unknown.size()) unknown.at(count++) = id;
  }
  return other_.update(std::span(unknown).first(count), frame.isMachineSeen, frame.ar->captureTime);
}

PoseEvidence OverlayRenderer::evidenceOf(const OverlayFrame& frame) const {
  PoseEvidence evidence{.hasPose = frame.machine.has_value(),
                        .isSeen = frame.isMachineSeen,
                        .partPx = HUGE_VAL,
                        .pxScale = pxScale_};
  if (!frame.machine) return evidence;
  const PxBox picture{glm::dvec2(0.0), glm::dvec2(size_.width, size_.height)};
  // Parts with a corner behind the camera have no box.
  const bool marksAny = !focus_.empty() || !content_->ghosts.empty();
  evidence.isOutOfView = marksAny && (!marked_ || !marked_->overlaps(picture));
  const scene::Attachment& attachment = frame.machine->attachment;
  for (std::size_t part = 0; part < boxes_.size(); ++part) {
    if (!boxes_[part]) continue;
    const glm::dvec3 centre(frame.machine->cameraFromBody * glm::dvec4(shapes_[part].centre, 1.0));
    evidence.errorPx = std::max(
        evidence.errorPx,
        predictedErrorPx(*frame.camera, attachment.covariance, attachment.turnsAbout, centre));
    const glm::dvec2 extent = boxes_[part]->size();
    evidence.partPx = std::min(evidence.partPx, std::max(extent.x, extent.y));
  }
  return evidence;
}

/// Parts that are hard to make out get thin outlines, and the inset beside them.
void OverlayRenderer::judgeSize(const PoseEvidence& evidence) {
  if (!marked_) return;
  constexpr double kUsualPartPx = 40.0;
  lineScale_ = pxScale_ * static_cast<float>(
                              std::clamp(evidence.partPx / (kUsualPartPx * pxScale_), 0.5, 1.0));
  constexpr double kSmall = 0.09;  // of the picture's width
  constexpr double kLarge = 0.11;
  double extent = 0.0;
  for (const std::size_t part : focus_) {
    if (boxes_[part]) extent = std::max({extent, boxes_[part]->size().x, boxes_[part]->size().y});
  }
  for (const Ghost& ghost : content_->ghosts) {
    if (const auto& box = boxes_[ghost.part]) {
      extent = std::max({extent, box->size().x, box->size().y});
    }
  }
  if (extent < kSmall * size_.width) isSmall_ = true;
  if (extent > kLarge * size_.width) isSmall_ = false;
}

/// The panel is below; above, where it would cover the parts for a while.
void OverlayRenderer::placePanel(hal::TimePoint now) {
  if (!panel_ || !marked_) return;
  const double width = size_.width;
  const double height = panel_.size().height;
  const PxBox below{{0.0, size_.height - height}, {width, double(size_.height)}};
  const PxBox above{{0.0, 0.0}, {width, height}};
  const double here = marked_->shared(isPanelBelow_ ? below : above);
  const double there = marked_->shared(isPanelBelow_ ? above : below);
  if (here <= 1.5 * there + 1.0) {
    panelBadSince_.reset();
    return;
  }
  if (!panelBadSince_) panelBadSince_ = now;
  const bool isNew = began_ == now;
  if (!isNew && now - *panelBadSince_ < kPanelBadFor) return;
  isPanelBelow_ = !isPanelBelow_;
  panelBadSince_.reset();
}

glm::ivec2 OverlayRenderer::insetPlace() const {
  const double margin = kOverlayMarginPx * pxScale_;
  const double panel = panel_ ? panel_.size().height : 0.0;
  const double top = isPanelBelow_ ? margin : panel + margin;
  return {static_cast<int>(size_.width - inset_.size().width - margin), static_cast<int>(top)};
}

float OverlayRenderer::phaseAt(hal::TimePoint now) const {
  constexpr double kPeriod = 2.4;  // seconds: it rests, moves, and rests
  constexpr double kStarts = 0.25;
  constexpr double kEnds = 1.7;
  const double seconds = std::fmod(hal::toSeconds(now - *began_), kPeriod);
  return static_cast<float>(eased(std::clamp((seconds - kStarts) / (kEnds - kStarts), 0.0, 1.0)));
}

const gpu::Texture& OverlayRenderer::draw(const OverlayFrame& frame) {
  assert(content_ != nullptr);
  const hal::TimePoint now = frame.ar->captureTime;
  if (!began_) began_ = now;
  if (machine_) {
    findBoxes(frame);
    PoseEvidence evidence = evidenceOf(frame);
    evidence.seesOtherMachine = seesOtherMachine(frame);
    evidence.isContradicted = contradictions_->update(*frame.tracked);
    state_ = {.trust = trust_.update(evidence, now), .predictedErrorPx = evidence.errorPx};
    judgeSize(evidence);
  } else {
    state_.trust = {.opacity = 0.0F, .doubt = Doubt::kNone, .standsIn = true};
  }
  placePanel(now);
  copy_.use()
      .texture("painted", *frame.painted)
      .set("outputSize", glm::vec2(size_.width, size_.height))
      .drawFullscreen(target_);
  if (frame.machine && state_.trust.opacity > 0.0F) {
    drawMarks(frame);
    drawLabels(frame);
  } else {
    layout_.reset();
    placed_ = {};
  }
  drawPanels(now);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return output_;
}

void OverlayRenderer::drawMarks(const OverlayFrame& frame) {
  lines_.clear();
  if (!marked_) return;
  const glm::dvec2 whole(size_.width, size_.height);
  struct Area {
    glm::ivec2 low{0};
    hal::FrameSize size;
  };
  const auto areaWithin = [&](double px) {
    const double margin = px * pxScale_ + 1.0;
    const glm::ivec2 low(glm::clamp(glm::floor(marked_->low - margin), glm::dvec2(0.0), whole));
    const glm::ivec2 high(glm::clamp(glm::ceil(marked_->high + margin), glm::dvec2(0.0), whole));
    return Area{low, {high.x - low.x, high.y - low.y}};
  };
  const Area area = areaWithin(5.0);
  const Area seen = areaWithin(10.0);  // outlines look that far beyond
  if (area.size.width <= 0 || area.size.height <= 0) return;
  const glm::vec2 outputSize(whole);
  figures_.draw(frame.machine->cameraFromBody, *frame.camera, phaseAt(frame.ar->captureTime));
  region_.use()
      .texture("ids", *frame.ar->ids)
      .texture("looks", lookTexture_)
      .set("outputSize", outputSize)
      .set("object", scene::objectId(scene_, *machine_))
      .drawArea(regionTarget_, seen.low, seen.size);
  marks_.use()
      .texture("painted", *frame.painted)
      .texture("composed", *frame.ar->colour)
      .texture("region", regionTexture_)
      .texture("figure", figures_.figure())
      .set("outputSize", outputSize)
      .set("opacity", state_.trust.opacity)
      .set("lineScale", lineScale_)
      .drawArea(target_, area.low, area.size);
  const double phase = phaseAt(frame.ar->captureTime);
  for (const Arrow& arrow : content_->arrows) {
    lines_.addArrowOf(arrow, alongAxis(shapes_[arrow.part], arrow.axis),
                      frame.machine->cameraFromBody, *frame.camera, pxScale_, phase);
  }
  drawing_.drawLines(target_, lines_.all(), pxScale_, state_.trust.opacity);
}

void OverlayRenderer::drawLabels(const OverlayFrame& frame) {
  const glm::dmat4& cameraFromModel = frame.machine->cameraFromBody;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    LabelTarget& target = targets_[i];
    target.sizePx = sizeOf(labelSprites_[i]);
    target.box.reset();
    double nearest = HUGE_VAL;
    for (const std::size_t part : content_->labels[i].parts) {
      if (!boxes_[part]) continue;
      target.box = target.box ? boxAround(*target.box, *boxes_[part]) : *boxes_[part];
      const double z = (cameraFromModel * glm::dvec4(shapes_[part].centre, 1.0)).z;
      if (z >= nearest) continue;
      nearest = z;
      target.anchor = shapes_[part].centre;
      target.aim = *boxes_[part];
    }
  }
  keepClear_.clear();
  if (panel_) {
    const double height = panel_.size().height;
    const double top = isPanelBelow_ ? size_.height - height : 0.0;
    keepClear_.push_back({{0.0, top}, {double(size_.width), top + height}});
  }
  if (inset_ && (isSmall_ || content_->showsInset || state_.trust.standsIn)) {
    const glm::dvec2 corner(insetPlace());
    keepClear_.push_back({corner, corner + sizeOf(inset_)});
  }
  for (const PxBox& each : lines_.arrowBoxes()) keepClear_.push_back(each);
  if (ghosts_) keepClear_.push_back(*ghosts_);
  placed_ = layout_.place({.camera = frame.camera,
                           .cameraFromModel = cameraFromModel,
                           .keepClear = keepClear_,
                           .time = frame.ar->captureTime},
                          targets_);
  leaders_.clear();
  for (const PlacedLabel& each : placed_) {
    if (each.isShown) leaders_.addLine(each.leaderFrom, each.leaderTo, 1.2 * pxScale_);
  }
  drawing_.drawLines(target_, leaders_.all(), pxScale_, state_.trust.opacity);
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    if (!placed_[i].isShown) continue;
    drawing_.drawSprite(target_, labelSprites_[i], placed_[i].topLeft, state_.trust.opacity);
  }
}

void OverlayRenderer::drawPanels(hal::TimePoint now) {
  if (panel_) {
    const glm::ivec2 corner{(size_.width - panel_.size().width) / 2,
                            isPanelBelow_ ? size_.height - panel_.size().height : 0};
    drawing_.drawSprite(target_, panel_, corner, 1.0F);
    if (movie_) {
      const MoviePlace& place = content_->moviePlace;
      drawing_.drawTexture(target_, movie_.at(now), corner + place.topLeft, place.size, 1.0F);
    }
  }
  if (!state_.trust.standsIn && !content_->showsInset && !isSmall_) return;
  const glm::ivec2 place = insetPlace();
  if (inset_) drawing_.drawSprite(target_, inset_, place, 1.0F);
  if (!state_.trust.standsIn) return;
  const Sprite& badge = badges_.at(static_cast<std::size_t>(state_.trust.doubt));
  if (!badge) return;
  const int margin = static_cast<int>(kOverlayMarginPx * pxScale_);
  drawing_.drawSprite(target_, badge, {margin, place.y}, 1.0F);
}

}  // namespace pleinair::overlay
