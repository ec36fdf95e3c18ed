#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/clock.h"
#include "pipeline/overlay/part_shape.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::overlay {

/// What a label points at, in one frame.
struct LabelTarget {
  glm::dvec2 sizePx{0.0};    ///< of the label's picture, whole
  glm::dvec3 anchor{0.0};    ///< in the model's frame, metres
  std::optional<PxBox> box;  ///< of the parts in the image; nothing: behind the camera
  PxBox aim;                 ///< of the one that the leader line goes to
};

/// Where the machine and its surroundings are, in one frame.
struct LabelView {
  const tracking::CameraModel* camera = nullptr;  ///< of the picture that is drawn on
  glm::dmat4 cameraFromModel{1.0};
  std::span<const PxBox> keepClear;  ///< panel, inset: labels do not lie there
  hal::TimePoint time;
};

/// Where a label is drawn.
struct PlacedLabel {
  bool isShown = false;
  glm::ivec2 topLeft{0};
  glm::dvec2 leaderFrom{0.0};  ///< on the label's border
  glm::dvec2 leaderTo{0.0};    ///< on the border of what it points at, or within it
};

/// Lays labels out beside what they point at, in object space: a label belongs to a point of the
/// model's frame and so moves with the machine. That point stays until the view has changed by 15°
/// or a tenth in scale, or the label has lain badly (over a part, another label, what is to be kept
/// clear, the border) for 300 ms; the label then moves within 200 ms. Labels lie on whole pixels,
/// and leave one only for a move of more than a pixel: tremor of the pose does not move them. They
/// never cover a part that one of them points at: such a label is moved at once.
/// Sources: Bell, Feiner, Höllerer, "View Management for Virtual and Augmented Reality", 2001;
/// Tatzgern et al., "Hedgehog Labeling", 2014. One thread; allocates only for more labels.
class LabelLayout {
 public:
  /// Labels beyond these are not shown: nobody reads them.
  static constexpr std::size_t kMost = 24;

  /// Places the labels of a frame; valid until the next call. Another number of labels begins anew.
  std::span<const PlacedLabel> place(const LabelView& view, std::span<const LabelTarget> targets);
  /// Forgets where labels were: another step, a cut.
  void reset() {
    slots_.clear();
    placed_.clear();
  }

 private:
  struct Slot {
    bool isLaid = false;
    glm::dvec3 point{0.0};         ///< of the label's centre, in the model's frame
    glm::dvec3 towardCamera{0.0};  ///< from the anchor when it was laid out, unit length
    double distance = 1.0;         ///< of the anchor then, metres
    std::optional<hal::TimePoint> badSince;
    glm::dvec2 moveFrom{0.0};  ///< px before the last change of `point`, relative to the new place
    std::optional<hal::TimePoint> moved;
    std::optional<glm::ivec2> shown;  ///< top left corner
  };

  void layOut(const LabelView& view, std::span<const LabelTarget> targets, std::size_t index);
  bool isStale(const LabelView& view, const LabelTarget& target, Slot& slot) const;
  void show(const LabelView& view, std::span<const LabelTarget> targets, std::size_t index);

  std::vector<Slot> slots_;
  std::vector<PlacedLabel> placed_;
};

}  // namespace pleinair::overlay
