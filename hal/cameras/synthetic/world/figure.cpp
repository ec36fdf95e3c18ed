#include "hal/cameras/synthetic/world/figure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include "hal/cameras/synthetic/world/canvas.h"
#include "hal/cameras/synthetic/world/materials.h"
#include "hal/cameras/synthetic/world/srgb.h"

namespace pleinair::hal::synthetic {
namespace {

struct Look {
  double height;  ///< metres
  std::uint32_t skin, hair, jacket, sleeves, trousers, shoes;
};
constexpr std::array<Look, kFigures> kLooks{
    {{1.74, 0xdba684, 0x3a271b, 0xb5432f, 0x94331f, 0x34405e, 0x231f1d},
     {1.66, 0xe6b898, 0xb98d4a, 0x2f72a8, 0x285f8d, 0x55504c, 0x7a3f28}}};

// The measures of a figure of the height kModelHeight, metres; all scale with the height.
constexpr double kModelHeight = 1.77;
constexpr double kShoulderUp = 0.495;  // from the hips
constexpr double kShoulderOut = 0.205;
constexpr double kNeckUp = 0.595;
constexpr double kHipOut = 0.085;
constexpr double kUpperArm = 0.29;
constexpr double kForearm = 0.25;
constexpr double kThigh = 0.43;
constexpr double kShin = 0.41;
constexpr double kAnkleUp = 0.075;  // from the sole
constexpr double kHeel = -0.06;     // the sole's ends, from the ankle
constexpr double kToes = 0.17;

double scaleOf(std::size_t figure) {
  return kLooks.at(figure).height / kModelHeight;
}

/// A joint at `at`, turned by `radians` about the axis to the left: what hangs swings backwards.
glm::dmat4 hinge(glm::dvec3 at, double radians) {
  return glm::rotate(glm::translate(glm::dmat4(1), at), radians, glm::dvec3(0, 1, 0));
}

std::size_t indexOf(FigurePart part) {
  return static_cast<std::size_t>(part);
}

void placeLimbs(const FigureJoints::Limbs& joints, double side, FigurePart upperArm,
                const glm::dmat4& trunk, FigurePoses& poses) {
  const std::size_t first = indexOf(upperArm);
  poses[first] = trunk * hinge({0, side * kShoulderOut, kShoulderUp}, -joints.shoulder);
  poses[first + 1] = poses[first] * hinge({0, 0, -kUpperArm}, -joints.elbow);
  poses[first + 2] = hinge({0, side * kHipOut, 0}, -joints.hip);
  poses[first + 3] = poses[first + 2] * hinge({0, 0, -kThigh}, joints.knee);
  poses[first + 4] = poses[first + 3] * hinge({0, 0, -kShin}, -joints.ankle);
}

/// The height of the lower sole, the hips being at 0.
double lowestOf(const FigurePoses& poses) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const FigurePart foot : {FigurePart::kLeftFoot, FigurePart::kRightFoot}) {
    for (const double x : {kHeel, kToes}) {
      lowest = std::min(lowest, (poses[indexOf(foot)] * glm::dvec4(x, 0, -kAnkleUp, 1)).z);
    }
  }
  return lowest;
}

/// The rings of an ellipsoid whose half height is `half`, with its middle at `z`.
std::vector<Builder::Ring> ellipsoid(double z, double half, int strips = 8) {
  std::vector<Builder::Ring> rings{{z - half, 0}};
  for (int i = 1; i < strips; ++i) {
    const double angle = std::numbers::pi * i / strips;
    rings.push_back({z - half * std::cos(angle), std::sin(angle)});
  }
  rings.push_back({z + half, 0});
  return rings;
}

/// The rings of a limb that hangs from the origin, with round ends.
std::vector<Builder::Ring> limb(double length, double topRadius, double endRadius) {
  return {{-length - 0.85 * endRadius, 0},
          {-length - 0.60 * endRadius, 0.72 * endRadius},
          {-length, endRadius},
          {-0.55 * length, 0.35 * endRadius + 0.68 * topRadius},
          {-0.15 * length, topRadius},
          {0.60 * topRadius, 0.80 * topRadius},
          {topRadius, 0}};
}

/// Adds the parts of one figure.
class FigureBuilder {
 public:
  FigureBuilder(Builder& builder, std::size_t figure, const glm::dmat4& worldFromFigure)
      : builder_(builder), figure_(figure), look_(kLooks.at(figure)) {
    const FigurePoses poses = figureFromParts(figure, {});
    for (std::size_t i = 0; i < litPoses_.size(); ++i) litPoses_[i] = worldFromFigure * poses[i];
  }

  void build() {
    buildTrunk();
    buildHead();
    buildLimbs(FigurePart::kLeftUpperArm);
    buildLimbs(FigurePart::kRightUpperArm);
  }

 private:
  void begin(FigurePart part) {
    builder_.patchSettings() = {.coarseness = 5,
                                .lightStep = 0.03,
                                .body = bodyOf(figure_, part),
                                .litPose = litPoses_[indexOf(part)]};
  }
  /// A turned surface, with the measures of the model; its front is the figure's.
  void add(std::vector<Builder::Ring> rings, double depth, double width, const Painter& painter,
           glm::dvec3 at = glm::dvec3(0), int sides = 12) {
    const double scale = scaleOf(figure_);
    for (Builder::Ring& ring : rings) ring.z *= scale;
    builder_.turned(uprightPose(scale * at, 90),
                    {std::move(rings), scale * glm::dvec2(width, depth), sides}, painter);
  }

  void buildTrunk() {
    begin(FigurePart::kTrunk);
    add({{-0.13, 0},
         {-0.125, 0.172},
         {0.00, 0.178},
         {0.16, 0.158},
         {0.30, 0.172},
         {0.42, 0.190},
         {0.49, 0.180},
         {0.535, 0.125},
         {0.565, 0.070},
         {0.575, 0}},
        0.69, 1.0, cloth(look_.jacket), {}, 20);
    add({{0.53, 1}, {0.64, 0.95}}, 0.052, 0.055, plain(look_.skin), {0.008, 0, 0});
  }

  void buildHead() {
    begin(FigurePart::kHead);
    builder_.patchSettings().coarseness = 2.5;
    builder_.patchSettings().lightStep = 0.015;
    const glm::vec3 skin = linearFromSrgb(look_.skin);
    const auto paintFace = [skin](Canvas& canvas) {
      canvas.paintAll([&](glm::vec2 p) {
        const glm::vec2 aside(std::abs(p.x), p.y);
        const float eye = discDistance(aside - glm::vec2(0.034F, 0.004F), 0.011F);
        const float brow = boxDistance(aside - glm::vec2(0.034F, 0.026F), {0.015F, 0.003F});
        const float mouth = boxDistance(p - glm::vec2(0, -0.066F), {0.022F, 0.004F});
        glm::vec3 colour = glm::mix(skin, linearFromSrgb(0x2a1d18), canvas.inside(eye));
        colour = glm::mix(colour, linearFromSrgb(0x4a3324), 0.8F * canvas.inside(brow));
        return glm::mix(colour, linearFromSrgb(0x9c4a40), canvas.inside(mouth));
      });
    };
    add(ellipsoid(0.115, 0.122, 16), 0.095, 0.077, paintFace, {0.014, 0, 0}, 24);
    add(ellipsoid(0.095, 0.022, 6), 0.020, 0.014, plain(look_.skin), {0.112, 0, 0}, 8);
    // The hair lies over the back of the head and leaves the face free.
    add(ellipsoid(0.150, 0.108, 16), 0.098, 0.089, cloth(look_.hair), {-0.020, 0, 0}, 24);
    add(ellipsoid(0.105, 0.022, 6), 0.012, 0.010, plain(look_.skin), {0.010, 0.078, 0}, 8);
    add(ellipsoid(0.105, 0.022, 6), 0.012, 0.010, plain(look_.skin), {0.010, -0.078, 0}, 8);
  }

  void buildLimbs(FigurePart upperArm) {
    const auto part = [upperArm](int after) {
      return static_cast<FigurePart>(static_cast<int>(upperArm) + after);
    };
    begin(part(0));
    add(limb(kUpperArm, 0.060, 0.047), 1, 1, cloth(look_.sleeves));
    begin(part(1));
    add(limb(kForearm, 0.046, 0.036), 1, 1, cloth(look_.sleeves));
    add(ellipsoid(-kForearm - 0.078, 0.082), 0.037, 0.024, plain(look_.skin), {0.006, 0, 0});
    begin(part(2));
    add(limb(kThigh, 0.088, 0.064), 1, 0.90, cloth(look_.trousers));
    begin(part(3));
    add(limb(kShin, 0.066, 0.047), 1, 0.95, cloth(look_.trousers));
    begin(part(4));
    add({{-kAnkleUp, 0}, {-kAnkleUp + 0.002, 0.92}, {-0.045, 1}, {-0.015, 0.80}, {0.005, 0}},
        (kToes - kHeel) / 2, 0.047, plain(look_.shoes), {(kToes + kHeel) / 2, 0, 0}, 14);
    add({{-0.06, 1}, {0.03, 0.9}}, 0.050, 0.042, plain(look_.shoes));
  }

  Builder& builder_;
  std::size_t figure_;
  const Look& look_;
  FigurePoses litPoses_{};
};

}  // namespace

FigurePoses figureFromParts(std::size_t figure, const FigureJoints& joints) {
  FigurePoses poses;
  const glm::dmat4 upright = glm::rotate(glm::dmat4(1), joints.twist, glm::dvec3(0, 0, 1));
  const glm::dmat4 trunk = upright * hinge({}, joints.lean);
  poses[indexOf(FigurePart::kTrunk)] = trunk;
  poses[indexOf(FigurePart::kHead)] =
      trunk * hinge({0, 0, kNeckUp}, -joints.lean) *
      glm::rotate(glm::dmat4(1), joints.headTurn, glm::dvec3(0, 0, 1)) * hinge({}, joints.headNod);
  placeLimbs(joints.left, 1, FigurePart::kLeftUpperArm, trunk, poses);
  placeLimbs(joints.right, -1, FigurePart::kRightUpperArm, trunk, poses);
  const double lowest = lowestOf(poses);
  for (glm::dmat4& pose : poses) {
    pose[3].z -= lowest;
    for (int axis = 0; axis < 3; ++axis) pose[3][axis] *= scaleOf(figure);
  }
  return poses;
}

double strideMetres(std::size_t figure, double hipRadians) {
  return 4 * std::sin(hipRadians) * (kThigh + kShin + kAnkleUp) * scaleOf(figure);
}

void buildFigures(Builder& builder, const std::array<glm::dmat4, kFigures>& worldFromFigures) {
  for (std::size_t figure = 0; figure < kFigures; ++figure) {
    FigureBuilder(builder, figure, worldFromFigures[figure]).build();
  }
}

}  // namespace pleinair::hal::synthetic
