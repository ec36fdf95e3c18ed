#include "pipeline/marks/anchors/anchor_set.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "pipeline/gpu/programs/program.h"
#include "pipeline/marks/fading_past.h"
#include "pipeline/marks/movers/layer_textures.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/render/scene_uniforms.h"

namespace pleinair::marks {
namespace {

const std::string kShaders = "pipeline/marks/anchors/shaders/";
constexpr std::size_t kCellBytes = 64;   // shaders/anchor_cells.glsl
constexpr int kMaxStrata = 4;            // along a cell's side (shaders/anchor_cells.glsl)
constexpr float kFaithfulPart = 0.025F;  // of the image (DensityRule::faithfulFactor)
constexpr unsigned kFirstModel = scene::kMaxPlanes;  // in SurfaceAccess::bodies
constexpr GLbitfield kStored = GL_SHADER_STORAGE_BARRIER_BIT;
constexpr std::array<std::uint32_t, 4> kNoneOccupied{0, 1, 1, 0};  // shaders/occupied_slots.glsl

glm::ivec2 gridOf(hal::FrameSize full, int cellPixels) {
  return {(full.width + cellPixels - 1) / cellPixels, (full.height + cellPixels - 1) / cellPixels};
}

/// Slots for every cell, including those beyond the border, at a density halfway between target and
/// deathAbove, for the anchors that fade out, and for those that other content covers. Detail adds
/// to the target alone.
std::uint32_t slotsFor(glm::ivec2 grid, const DensityRule& rule) {
  const int cells = (grid.x + 2) * (grid.y + 2);
  const int plain = cells * (rule.target + rule.deathAbove);
  const auto twiceTarget = static_cast<float>(2 * cells * rule.target);
  const float more = rule.detailFactor - 1.0F + kFaithfulPart * (rule.faithfulFactor - 1.0F);
  const int twice = plain + static_cast<int>(more * twiceTarget);
  const int fading = twice / 10;
  const int covered = plain / 4;
  return static_cast<std::uint32_t>((twice + fading + covered + 1) / 2);
}

/// Of the full image's camera, px. Precondition: the frame has surfaces.
glm::vec2 focalOf(const scene::ArFrame& frame) {
  const tracking::Intrinsics& pinhole = frame.surfaces->camera->intrinsics();
  return glm::vec2(pinhole.fx, pinhole.fy) / glm::vec2(frame.pixelsOfFull());
}

/// By how much most of the image has grown since the previous frame, in octaves of length.
double zoomOctaves(const scene::ArFrame& frame) {
  if (!frame.measuredMotion || frame.measuredMotion->motion == nullptr) return 0.0;
  const tracking::ImageMotion& measured = *frame.measuredMotion->motion;
  if (!measured.picture) return 0.0;
  const glm::dmat3& h = measured.picture->currentFromPrevious;
  const glm::dvec2 centre(0.5 * measured.frameSize.width, 0.5 * measured.frameSize.height);
  const glm::dvec3 middle = h * glm::dvec3(centre, 1.0);
  if (middle.z <= 0.0) return 0.0;
  // The determinant of a homography's Jacobian is det H / w³.
  const double area = glm::determinant(h) / (middle.z * middle.z * middle.z);
  constexpr double kMostOctaves = 0.5;  // a frame: more is no zoom
  return area > 0.0 ? std::clamp(0.5 * std::log2(area), -kMostOctaves, kMostOctaves) : 0.0;
}

/// The part of a fade of this length that `step` completes.
float fadeOf(hal::Duration step, hal::Duration length) {
  if (length <= hal::Duration(0)) return 1.0F;
  return static_cast<float>(static_cast<double>(step.count()) /
                            static_cast<double>(length.count()));
}

}  // namespace

struct AnchorSet::State {
  State(const gpu::ShaderLibrary& library, hal::FrameSize fullSize, AnchorOptions given)
      : full(fullSize),
        options(given),
        grid(gridOf(full, given.density.cellPixels)),
        slots(slotsFor(grid, given.density)),
        image(library.compute(kShaders + "anchor_image.comp")),
        surface(library.compute(kShaders + "anchor_surface.comp")),
        count(library.compute(kShaders + "anchor_count.comp")),
        choice(library.compute(kShaders + "anchor_choice.comp")),
        density(library.compute(kShaders + "anchor_density.comp")),
        plan(library.compute(kShaders + "anchor_plan.comp")),
        spawn(library.compute(kShaders + "anchor_spawn.comp")),
        anchors(slots * sizeof(Anchor), gpu::BufferUsage::kDynamic),
        cells(static_cast<std::size_t>(grid.x * grid.y) * kCellBytes, gpu::BufferUsage::kDynamic),
        births((slots + 1) * sizeof(std::uint32_t), gpu::BufferUsage::kDynamic),
        occupied((slots + 4) * sizeof(std::uint32_t), gpu::BufferUsage::kDynamic),
        noBodies(scene::SurfaceAccess::kBodyBytes, gpu::BufferUsage::kStatic),
        noIds(gpu::TextureFormat::kR32ui, {1, 1}) {
    anchors.write(std::vector<std::byte>(anchors.sizeBytes()));
    occupied.write(std::as_bytes(std::span(kNoneOccupied)));
    cells.write(std::vector<std::byte>(cells.sizeBytes()));
  }

  hal::FrameSize full;
  AnchorOptions options;
  glm::ivec2 grid;
  std::uint32_t slots;
  gpu::Program image;
  gpu::Program surface;
  gpu::Program count;
  gpu::Program choice;
  gpu::Program density;
  gpu::Program plan;
  gpu::Program spawn;
  gpu::Buffer anchors;
  gpu::Buffer cells;
  gpu::Buffer births;    // the free slots, in order
  gpu::Buffer occupied;  // passes are dispatched for these slots (shaders/occupied_slots.glsl)
  gpu::Buffer noBodies;
  gpu::Texture noIds;
  LayerTextures layerTextures;
  const MotionLayers* layers = nullptr;  // of this frame; null: movers are not told apart
  const TensorField* field = nullptr;
  hal::TimePoint lastTime;
  std::uint32_t salt = 0;     // of this frame's spawns
  double scaleOctaves = 0.0;  // of the image, as compared to when it began
  bool hasPast = false;
  bool hasBegunAnew = true;

  glm::ivec2 allSlots() const { return {static_cast<int>(slots), 1}; }
  int strataSide() const {
    const double side = std::ceil(std::sqrt(static_cast<double>(options.density.target)));
    return std::clamp(static_cast<int>(side), 1, kMaxStrata);
  }
  /// The margin beyond the border in which anchors live on: an anchor that jitters at the border
  /// must not be respawned every frame.
  float margin() const { return static_cast<float>(options.density.cellPixels); }

  /// For programs that look at the frame.
  gpu::Program& setFrame(gpu::Program& program, const scene::ArFrame& frame) {
    return program.texture("ids", frame.hasObjects ? *frame.ids : noIds)
        .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
        .set("fullSize", glm::vec2(full.width, full.height));
  }
  /// For programs that carry anchors.
  gpu::Program& beginCarrying(gpu::Program& program, const scene::ArFrame& frame) {
    return setFrame(program.use(), frame).set("margin", margin());
  }
  /// For programs of cells of density.
  gpu::Program& beginCells(gpu::Program& program) {
    return program.use()
        .set("grid", grid)
        .set("cellPixels", options.density.cellPixels)
        .set("strataSide", strataSide());
  }

  /// Dispatches the program, which is in use, for all occupied slots.
  void dispatchOccupied(gpu::Program& program) {
    program.storage("OccupiedSlots", occupied)
        .dispatchListed(occupied, 0, program.groupsFor(allSlots()), kStored);
  }

  /// What there are slots for.
  float faithfulFactor(const FidelityField& fidelity) const {
    const float most = kFaithfulPart * static_cast<float>(full.pixels());
    const float part = std::min(1.0F, most / std::max(fidelity.areaPx(), 1.0F));
    return 1.0F + part * (options.density.faithfulFactor - 1.0F);
  }
  void carryOnSurfaces(const scene::ArFrame& frame);
  void carryInImage(const scene::ArFrame& frame, const MotionField& motion, const AnchorHold& hold,
                    hal::Duration step, bool onSurfaces);
  void countAnchors(const scene::ArFrame& frame, const AnchorHold& hold, hal::Duration step);
  void keepDensity(const scene::ArFrame& frame, const MotionField& motion, const AnchorHold& hold);
};

/// By the surfaces of all models, in one dispatch.
void AnchorSet::State::carryOnSurfaces(const scene::ArFrame& frame) {
  const scene::SurfaceAccess& access = *frame.surfaces;
  const tracking::Intrinsics& pinhole = access.camera->intrinsics();
  const glm::vec2 pixelsOfFull(frame.pixelsOfFull());
  beginCarrying(surface, frame)
      .set("slots", slots)
      .texture("depth", *frame.depth)
      .storage("Posed", *access.posed)
      .storage("Triangles", *access.triangles)
      .storage("Anchors", anchors)
      .storage("Bodies", *access.bodies)
      .set("firstModel", kFirstModel)
      .set("nearMetres", frame.nearMetres)
      .set("farMetres", frame.farMetres)
      .set("focal", focalOf(frame))
      .set("centre", glm::vec2(pinhole.cx, pinhole.cy) / pixelsOfFull);
  scene::setLens(surface, *access.camera);
  surface.dispatch(allSlots(), kStored);
}

void AnchorSet::State::carryInImage(const scene::ArFrame& frame, const MotionField& motion,
                                    const AnchorHold& hold, hal::Duration step, bool onSurfaces) {
  beginCarrying(image, frame)
      .set("hasObjects", frame.hasObjects ? 1 : 0)
      .set("onSurfaces", onSurfaces ? 1 : 0)
      .set("firstModel", kFirstModel)
      .texture("barycentrics", frame.barycentrics != nullptr ? *frame.barycentrics : noIds)
      .storage("Anchors", anchors)
      .storage("Bodies", onSurfaces ? *frame.surfaces->bodies : noBodies);
  motion.bind(image);
  image.texture("picture", *frame.colour)
      .texture("moverShares", layerTextures.sharesOf(layers))
      .texture("background", layerTextures.backgroundOf(layers))
      .texture("moverMotion", layerTextures.moverMotionOf(layers))
      .set("noise", static_cast<float>(motion.noiseLevels() / 255.0))
      .set("stepSeconds", std::chrono::duration<float>(step).count())
      .set("memorySeconds", static_cast<float>(hal::toSeconds(hold.memory)))
      .set("restsWithCamera", layers != nullptr && layers->isStanding() ? 1 : 0)
      .set("underModels", hold.underModels ? 1 : 0)
      .set("follows", motion.follows() ? 1 : 0)
      .set("anew", hasBegunAnew ? 1 : 0);
  dispatchOccupied(image);
}

void AnchorSet::State::countAnchors(const scene::ArFrame& frame, const AnchorHold& hold,
                                    hal::Duration step) {
  setFrame(beginCells(count), frame)
      .texture("forms", frame.hasObjects ? *frame.forms : noIds)
      .set("hasObjects", frame.hasObjects ? 1 : 0)
      .storage("Anchors", anchors)
      .storage("Cells", cells)
      .set("fadeIn", fadeOf(step, hold.fadeIn))
      .set("fadeOut", fadeOf(step, hold.fadeOut))
      .set("moverFadeOut", fadeOf(step, std::min(hold.fadeOut, hold.moverFadeOut)));
  dispatchOccupied(count);
  setFrame(beginCells(choice), frame)
      .texture("forms", frame.hasObjects ? *frame.forms : noIds)
      .set("hasObjects", frame.hasObjects ? 1 : 0)
      .storage("Anchors", anchors)
      .storage("Cells", cells);
  dispatchOccupied(choice);
}

void AnchorSet::State::keepDensity(const scene::ArFrame& frame, const MotionField& motion,
                                   const AnchorHold& hold) {
  const DensityRule& rule = options.density;
  const std::size_t detailLevel = field != nullptr ? field->detailLevel() : 0;
  setFrame(beginCells(density), frame)
      .set("hasObjects", frame.hasObjects ? 1 : 0)
      .set("objectBounds", frame.objectBoundsOrAll())
      .storage("Anchors", anchors)
      .storage("Cells", cells)
      .texture("movers", layerTextures.labelsOf(layers))
      .texture("forms", frame.hasObjects ? *frame.forms : noIds)
      .texture("detailField", field != nullptr ? field->resolved(detailLevel) : motion.backward())
      .set("detailScale", field != nullptr ? field->textureScale(detailLevel) : glm::vec2(1.0F))
      .texture("moverField", field != nullptr ? field->movers() : motion.backward())
      .set("moverScale", field != nullptr ? field->textureScale(0) : glm::vec2(1.0F))
      .set("detailFactor", field != nullptr ? rule.detailFactor : 1.0F)
      .set("detailRange", rule.detailRange)
      .set("target", rule.target)
      .set("birthBelow", hold.hasSlack ? rule.birthBelow : rule.target)
      .set("deathAbove", hold.hasSlack ? rule.deathAbove : rule.target)
      .set("hasMoverSlack", hold.hasMoverSlack ? 1 : 0);
  hold.fidelity.bind(density);
  density.set("faithfulFactor", faithfulFactor(hold.fidelity));
  density.dispatch(grid, kStored);
  beginCells(plan)
      .set("slots", slots)
      .storage("Anchors", anchors)
      .storage("Cells", cells)
      .storage("Plan", births)
      .storage("OccupiedSlots", occupied)
      .set("cellCount", static_cast<unsigned>(grid.x * grid.y))
      .dispatch({1, 1}, kStored | GL_COMMAND_BARRIER_BIT);
  const bool hasDepth = frame.hasObjects && frame.depth != nullptr && frame.surfaces.has_value();
  const gpu::Texture* const before = field != nullptr ? field->patchesBefore() : nullptr;
  setFrame(beginCells(spawn), frame)
      .set("hasObjects", frame.hasObjects ? 1 : 0)
      .texture("barycentrics", frame.barycentrics != nullptr ? *frame.barycentrics : noIds)
      .texture("motion", motion.backward())
      .texture("forms", frame.hasObjects ? *frame.forms : noIds)
      .texture("surfaceMotion", frame.motion ? *frame.motion->texture : motion.backward())
      .texture("patches", before != nullptr ? *field->patches() : noIds)
      .texture("patchesBefore", before != nullptr ? *before : noIds)
      .set("hasPatches", before != nullptr && frame.hasObjects ? 1 : 0)
      .set("patchPixels", static_cast<float>(field != nullptr ? field->regionPixels(0) : 1.0))
      .texture("movers", layerTextures.labelsOf(layers))
      .texture("moverShares", layerTextures.sharesOf(layers))
      .texture("depth", hasDepth ? *frame.depth : motion.backward())
      .set("depthRange", hasDepth ? glm::vec2(frame.nearMetres, frame.farMetres) : glm::vec2(0.0F))
      .set("focalPx", hasDepth ? focalOf(frame).y : 1.0F)
      .set("scale", static_cast<float>(scaleOctaves))
      .set("target", rule.target)
      .texture("picture", frame.camera())
      .set("accentPixels", options.accentPixels)
      .storage("Anchors", anchors)
      .storage("Cells", cells)
      .storage("Plan", births)
      .set("salt", options.seed * 0x9E3779B9U + salt)
      .set("atOnce", hasBegunAnew || hold.fadeIn <= hal::Duration(0) ? 1 : 0)
      .dispatch(grid, kStored | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
}

AnchorSet::AnchorSet(const gpu::ShaderLibrary& library, hal::FrameSize full, AnchorOptions options)
    : state_(std::make_unique<State>(library, full, options)) {
  [[maybe_unused]] const DensityRule& rule = options.density;
  assert(rule.cellPixels > 0 && rule.birthBelow <= rule.target && rule.target <= rule.deathAbove);
  assert(static_cast<float>(rule.target) * std::max(rule.detailFactor, rule.faithfulFactor) <
         63.0F);
}

AnchorSet::~AnchorSet() = default;

void AnchorSet::advance(const scene::ArFrame& frame, const MotionField& motion,
                        const AnchorHold& hold, const MotionLayers* layers,
                        const TensorField* field) {
  State& s = *state_;
  assert(frame.full() == s.full);
  assert(!frame.hasObjects || (frame.barycentrics != nullptr && frame.forms != nullptr));
  s.hasBegunAnew = !s.hasPast || motion.isCut();
  const hal::Duration step = s.hasPast ? timeStep(s.lastTime, frame.captureTime) : hal::Duration(0);
  s.lastTime = frame.captureTime;
  s.hasPast = true;
  s.layers = layers;
  s.field = field;
  if (motion.isCut()) s.salt = 0;  // as in a first frame
  s.scaleOctaves = s.hasBegunAnew ? 0.0 : s.scaleOctaves + zoomOctaves(frame);
  ++s.salt;
  const bool onSurfaces =
      frame.surfaces && frame.surfaces->posed != nullptr && !s.hasBegunAnew && motion.follows();
  if (onSurfaces) s.carryOnSurfaces(frame);
  s.carryInImage(frame, motion, hold, step, onSurfaces);
  s.countAnchors(frame, hold, step);
  s.keepDensity(frame, motion, hold);
}

bool AnchorSet::hasBegunAnew() const {
  return state_->hasBegunAnew;
}

const gpu::Buffer& AnchorSet::anchors() const {
  return state_->anchors;
}

std::uint32_t AnchorSet::slotCount() const {
  return state_->slots;
}

const AnchorOptions& AnchorSet::options() const {
  return state_->options;
}

double AnchorSet::imageScale() const {
  return state_->scaleOctaves;
}

std::vector<Anchor> AnchorSet::read() const {
  std::vector<Anchor> read(state_->slots);
  state_->anchors.read(std::as_writable_bytes(std::span(read)));  // stays free if the GPU was lost
  return read;
}

void AnchorSet::beginAnew() {
  state_->hasPast = false;
}

void AnchorSet::reset() {
  state_->hasPast = false;
  state_->salt = 0;
}

}  // namespace pleinair::marks
