#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "pipeline/marks/anchors/anchor_set.h"
#include "pipeline/marks/movers/motion_layers.h"
#include "pipeline/marks/strokes/stroke_set.h"
#include "tests/gpu/marks/tensor_fixture.h"

namespace pleinair::marks {

/// shaders/stroke.glsl's, as it lies in the buffer.
struct StrokeSlot {
  std::array<glm::vec2, 4> ahead;
  std::array<glm::vec2, 4> behind;
  glm::vec2 lengths;
  float exists;
  std::uint32_t state;
  glm::vec3 colour;
  float seen;
};
static_assert(sizeof(StrokeSlot) == 96);

/// shaders/stroke_instances.comp's.
struct StrokeInstance {
  std::array<glm::vec2, 8> points;
  glm::vec4 paint;
  float halfWidth;
  float variant;
  float label;
  float age;
};
static_assert(sizeof(StrokeInstance) == StrokeSet::kInstanceBytes);

/// Where a stroke's skeleton leads, before it is laid out.
struct StrokeTips {
  glm::vec2 anchor;
  glm::vec2 ahead;
  glm::vec2 behind;
  std::vector<glm::vec2> polyline;  ///< all of both arms, also beyond the tips
  glm::vec3 colour;
  float seen;
  std::uint32_t surface;
};

/// Anchors, a field and their strokes on pictures that are made up.
class StrokeTest : public TensorTest {
 protected:
  static constexpr TensorFieldOptions kNoMemory{
      .form = 0.0, .memory = hal::Duration(0), .slack = 0.0};
  static constexpr float kNear = 0.1F;  ///< metres
  static constexpr float kFar = 10.0F;

  void SetUp() override {
    TensorTest::SetUp();
    if (IsSkipped()) return;
    motionField_.emplace(library_, kSize);
    beginAnew();
  }

  void beginAnew(const AnchorOptions& options = {.density = {.cellPixels = 12}}) {
    strokes_.reset();
    anchors_.reset();
    field_.emplace(library_, kSize);
    anchors_.emplace(library_, kSize, options);
    strokes_.emplace(library_, anchors_->slotCount());
  }

  /// A virtual object (1) where `isInside` says so.
  void useObject(const std::function<bool(glm::vec2)>& isInside) {
    usePatches([&](glm::vec2 px) { return isInside(px) ? 1U : 0U; });
  }
  /// The patches of a virtual object (1), each a triangle; 0: the camera's picture.
  /// With the marks of surface_form.glsl.
  void usePatches(const std::function<std::uint32_t(glm::vec2)>& patchAt) {
    std::vector<std::uint32_t> ids;
    std::vector<std::uint32_t> forms;  // labels without directions
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        forms.push_back(patchAt({x, y}));
        const std::uint32_t label = forms.back() & 4095U;
        ids.push_back(label != 0U ? (1U << scene::kTriangleBits) | label : 0U);
      }
    }
    const std::size_t stride = std::size_t{kSize.width} * 4;
    ids_ = gpu::Texture(gpu::TextureFormat::kR32ui, kSize);
    ids_.upload({reinterpret_cast<const std::uint8_t*>(ids.data()), ids.size() * 4}, stride);
    forms_ = gpu::Texture(gpu::TextureFormat::kR32ui, kSize);
    forms_.upload({reinterpret_cast<const std::uint8_t*>(forms.data()), forms.size() * 4}, stride);
    zeros_ = gpu::Texture(gpu::TextureFormat::kR32ui, kSize);
    zeros_.upload(std::vector<std::uint8_t>(ids.size() * 4), stride);
    hasObject_ = true;
  }

  /// How far the object's surfaces are, in metres between 0.1 and 10.
  void useDepth(const std::function<float(glm::vec2)>& metresAt) {
    std::vector<float> windows;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        windows.push_back((kFar - kNear * kFar / metresAt({x, y})) / (kFar - kNear));
      }
    }
    depth_.emplace(gpu::TextureFormat::kR32f, kSize);
    depth_->upload({reinterpret_cast<const std::uint8_t*>(windows.data()), windows.size() * 4},
                   std::size_t{kSize.width} * 4);
  }

  /// The next frame; colours are `paint`'s, else the picture's.
  void advance(const hal::Image& picture, const StrokeRule& rule,
               const tracking::ImageMotion& motion = standing(), const hal::Image* paint = nullptr,
               hal::Duration step = kStep) {
    const gpu::Texture texture = support::textureOf(picture.view());
    const gpu::Texture colours = support::textureOf(paint ? paint->view() : picture.view());
    scene::ArFrame frame = frameOf(texture, motion, step);
    frame.hasObjects = hasObject_;
    if (hasObject_) {
      frame.ids = &ids_;
      frame.forms = &forms_;
      frame.barycentrics = &zeros_;
      frame.normalFocus = &texture;
      if (depth_) frame.depth = &*depth_;
      frame.nearMetres = kNear;
      frame.farMetres = kFar;
    }
    motionField_->update(frame, {.follows = follows_});
    if (layers_) layers_->update(frame, *motionField_);
    const MotionLayers* const layers = layers_ ? &*layers_ : nullptr;
    field_->update(frame, texture, *motionField_, kNoMemory, layers);
    anchors_->advance(frame, *motionField_, {}, layers);
    const StrokePaint paints{.background = &colours,
                             .models = mixed_ ? &*mixed_ : &colours,
                             .movers = &colours,
                             .fineModels = &colours,
                             .modelTexelPx = mixed_ ? kMixedPx : 1.0F};
    strokes_->update(frame, *anchors_, *field_, paints, rule, layers);
  }

  std::vector<StrokeSlot> readStrokes() const {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    return support::readBuffer<StrokeSlot>(strokes_->strokes());
  }
  /// In the order of painting.
  std::vector<StrokeInstance> readInstances() const {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    auto instances = support::readBuffer<StrokeInstance>(strokes_->instances());
    instances.resize(support::readBuffer<std::uint32_t>(strokes_->command())[1]);
    return instances;
  }
  std::vector<std::pair<std::size_t, Anchor>> alive() const {
    std::vector<std::pair<std::size_t, Anchor>> found;
    const std::vector<Anchor> all = anchors_->read();
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].isAlive()) found.emplace_back(i, all[i]);
    }
    return found;
  }

  /// `more`: added to lengths, in segments.
  std::vector<StrokeTips> tips(float segmentPx, float more = 0.0F) const {
    const std::vector<StrokeSlot> strokes = readStrokes();
    std::vector<StrokeTips> found;
    for (const auto& [slot, anchor] : alive()) {
      const StrokeSlot& stroke = strokes[slot];
      StrokeTips tips{.anchor = anchor.px,
                      .ahead = anchor.px,
                      .behind = anchor.px,
                      .polyline = {anchor.px},
                      .colour = stroke.colour,
                      .seen = stroke.seen,
                      .surface = anchor.surface};
      for (std::size_t i = 0; i < 4; ++i) {
        const auto before = static_cast<float>(i);
        tips.ahead +=
            segmentPx * std::clamp(stroke.lengths.x + more - before, 0.0F, 1.0F) * stroke.ahead[i];
        tips.behind +=
            segmentPx * std::clamp(stroke.lengths.y + more - before, 0.0F, 1.0F) * stroke.behind[i];
        tips.polyline.push_back(tips.polyline.back() + segmentPx * stroke.ahead[i]);
        tips.polyline.insert(tips.polyline.begin(),
                             tips.polyline.front() + segmentPx * stroke.behind[i]);
      }
      found.push_back(std::move(tips));
    }
    return found;
  }

  std::optional<MotionField> motionField_;
  std::optional<MotionLayers> layers_;  ///< empty: movers are not told apart
  std::optional<TensorField> field_;
  std::optional<AnchorSet> anchors_;
  std::optional<StrokeSet> strokes_;
  static constexpr float kMixedPx = 16.0F;
  std::optional<gpu::Texture> mixed_;  ///< the image of models, of texels so wide, if not the paint
  bool follows_ = true;                ///< anchors move with the picture; without, none is hidden
  gpu::Texture ids_;
  gpu::Texture forms_;
  std::optional<gpu::Texture> depth_;  ///< as a depth buffer holds it
  gpu::Texture zeros_;
  bool hasObject_ = false;
};

}  // namespace pleinair::marks
