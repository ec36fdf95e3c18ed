#include <array>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "hal/cameras/synthetic/world/light.h"
#include "hal/cameras/synthetic/world/materials.h"
#include "hal/cameras/synthetic/world/papers.h"
#include "hal/cameras/synthetic/world/srgb.h"
#include "hal/cameras/synthetic/world/workbench.h"

namespace pleinair::hal::synthetic {
namespace {

/// A pose relative to another, turned by `degrees` about its z.
glm::dmat4 within(const glm::dmat4& pose, glm::dvec3 position, double degrees = 0) {
  return pose * uprightPose(position, degrees);
}

Painter withTag(const Painter& below, int id, glm::vec2 at) {
  return layered(below, [=](Canvas& canvas) {
    paintTagCard(canvas, {at, 0}, benchTags()[static_cast<std::size_t>(id)]);
  });
}

void buildToolbox(Builder& builder) {
  constexpr std::uint32_t kRed = 0xb04a30;
  const glm::dmat4& pose = kToolboxPose;
  const glm::dvec3 size = kToolboxSize;
  builder.patchSettings() = {.coarseness = 1, .lightStep = 0.008};
  builder.box(pose, size,
              {.other = enamel(kRed), .front = withTag(enamel(kRed), 1, {0.02F, -0.012F})});
  builder.box(within(pose, {0, 0, size.z}), {size.x + 0.012, size.y + 0.012, 0.034},
              {.other = enamel(0x9c402a), .bottom = plain(0x6e2c1c)});
  for (const double x : {-0.115, 0.145}) {
    builder.box(within(pose, {x, -size.y / 2 - 0.008, size.z - 0.028}), {0.034, 0.007, 0.046},
                {.other = steel(0xb9b39f), .bottom = plain(0x77715f)});
  }
  const double lid = size.z + 0.034;
  for (const double x : {-0.085, 0.085}) {
    builder.box(within(pose, {x, 0, lid}), {0.014, 0.03, 0.036}, {.other = enamel(0x3a3d40)});
  }
  builder.rod(moved(pose, {-0.105, 0, lid + 0.036}), moved(pose, {0.105, 0, lid + 0.036}), 0.011,
              0.011, 14, polished(0x4a4d50));
}

void buildGearMotor(Builder& builder) {
  constexpr std::uint32_t kTeal = 0x4c7f7a;
  const glm::dmat4& pose = kMachinePose;
  const glm::dvec3 size = kMachineSize;
  builder.patchSettings() = {.coarseness = 1, .lightStep = 0.008};
  builder.box(within(pose, {0.04, 0, -0.014}), {0.38, 0.19, 0.014}, {.other = enamel(0x3c4448)});
  builder.box(pose, size,
              {.other = enamel(kTeal), .front = withTag(enamel(kTeal), 2, {-0.03F, 0})});
  builder.box(within(pose, {0, 0, size.z}), {size.x - 0.03, size.y - 0.03, 0.014},
              {.other = enamel(0x5b8f88)});
  builder.cylinder(within(pose, {-0.05, 0.01, size.z + 0.014}), {0.012, 0.010, 0.022, 12},
                   polished(0xa88a4a), plain(0x8f7640));
  for (const double x : {-0.085, 0.085}) {
    for (const double y : {-0.055, 0.055}) {
      builder.cylinder(within(pose, {x, y, size.z + 0.014}), {0.008, 0.008, 0.006, 6},
                       plain(0x8d9192), plain(0xa4a8a8));
    }
  }
  const double axle = 0.080;
  builder.rod(moved(pose, {size.x / 2, 0, axle}), moved(pose, {size.x / 2 + 0.016, 0, axle}), 0.066,
              0.066, 28, plain(0x3e6a66), plain(0x3e6a66));
  builder.rod(moved(pose, {size.x / 2 + 0.016, 0, axle}),
              moved(pose, {size.x / 2 + 0.135, 0, axle}), 0.056, 0.056, 28,
              striped(0x5a666c, 0x3c464b, 0.0245F, 0.55F), plain(0x4c575c));
  builder.rod(moved(pose, {size.x / 2 + 0.135, 0, axle}),
              moved(pose, {size.x / 2 + 0.160, 0, axle}), 0.058, 0.050, 28, plain(0x39434a),
              plain(0x39434a));
  builder.rod(moved(pose, {-size.x / 2 - 0.010, 0, axle}), moved(pose, {-size.x / 2, 0, axle}),
              0.034, 0.038, 24, polished(0x6b7274), plain(0x6b7274));
  builder.rod(moved(pose, {-size.x / 2 - 0.062, 0, axle}),
              moved(pose, {-size.x / 2 - 0.010, 0, axle}), 0.012, 0.012, 16, polished(0xb9bcbc),
              plain(0xa2a5a5));
}

void buildVise(Builder& builder) {
  constexpr std::uint32_t kIron = 0x47606e;
  const glm::dmat4 pose = uprightPose({0.50, -0.215, 0}, -24);
  const Painter iron = enamel(kIron);
  builder.patchSettings() = {.coarseness = 1, .lightStep = 0.007};
  builder.cylinder(pose, {0.078, 0.074, 0.024, 28}, plain(kIron), plain(kIron));
  builder.box(within(pose, {0, 0.02, 0.024}), {0.088, 0.13, 0.062}, {.other = iron});
  builder.box(within(pose, {0, 0.035, 0.086}), {0.135, 0.050, 0.058}, {.other = iron});
  builder.box(within(pose, {0, 0.050, 0.144}), {0.070, 0.060, 0.012}, {.other = steel(0x8b9294)});
  builder.box(within(pose, {0, 0.005, 0.100}), {0.125, 0.010, 0.038}, {.other = steel()});
  builder.box(within(pose, {0, -0.080, 0.032}), {0.046, 0.10, 0.040},
              {.other = steel(0x7d8588), .bottom = plain(0x565d60)});
  builder.box(within(pose, {0, -0.072, 0.072}), {0.135, 0.044, 0.068},
              {.other = iron, .bottom = plain(0x33434c)});
  builder.box(within(pose, {0, -0.046, 0.100}), {0.125, 0.008, 0.038}, {.other = steel()});
  // A brass bar between the jaws.
  builder.box(within(pose, {0.012, -0.021, 0.094}), {0.030, 0.040, 0.085},
              {.other = steel(0xbb9348)});
  const glm::dvec3 screw = moved(pose, {0, -0.130, 0.062});
  builder.rod(screw, moved(pose, {0, -0.185, 0.062}), 0.016, 0.016, 16, polished(0x90979a),
              plain(0x7f8688));
  const glm::dvec3 hub = moved(pose, {0, -0.172, 0.062});
  const glm::dvec3 along = glm::normalize(moved(pose, {0.82, -0.172, -0.42}) - hub);
  builder.rod(hub - 0.055 * along, hub + 0.125 * along, 0.0065, 0.0065, 12, polished(0xb2b6b7));
  builder.rod(hub - 0.066 * along, hub - 0.052 * along, 0.011, 0.011, 12, polished(0x9aa0a2));
  builder.rod(hub + 0.122 * along, hub + 0.136 * along, 0.011, 0.011, 12, polished(0x9aa0a2));
}

/// The lamp's own glow on the inside of its shade.
void paintGlow(Canvas& canvas) {
  canvas.paintAll([&](glm::vec2 p) {
    const float in = 0.5F + 0.5F * p.y / canvas.half().y;
    return glm::mix(glm::vec3(0.80F, 0.52F, 0.22F), glm::vec3(1.0F, 0.90F, 0.66F), in);
  });
}

void buildLamp(Builder& builder) {
  constexpr std::uint32_t kBlack = 0x3b4442;
  const glm::dvec3 foot(0.285, 0.345, 0);
  const glm::dvec3 elbow(0.415, 0.365, 0.36);
  const glm::dvec3 out = glm::normalize(kLampAxis);
  const glm::dvec3 mouth = glm::dvec3(kLampAt) - 0.004 * out;
  const glm::dvec3 neck = mouth - 0.105 * out;
  builder.patchSettings() = {.coarseness = 1, .lightStep = 0.008};
  builder.cylinder(uprightPose(foot), {0.072, 0.066, 0.016, 28}, plain(kBlack), plain(kBlack));
  builder.rod(foot + glm::dvec3(0, 0, 0.016), elbow, 0.008, 0.008, 12, polished(0x6a716e));
  builder.rod(elbow - glm::dvec3(0.013, 0, 0), elbow + glm::dvec3(0.013, 0, 0), 0.016, 0.016, 14,
              plain(kBlack));
  builder.rod(elbow, neck - 0.012 * out, 0.007, 0.007, 12, polished(0x6a716e));
  builder.rod(neck - 0.030 * out, neck, 0.020, 0.027, 20, plain(kBlack));
  // The shade is visible from inside, too, and has no bottom, which would block the lamp's own
  // light.
  const glm::dmat4 pose = [&] {
    const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), -out));
    return glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(-out, x), 0), glm::dvec4(-out, 0),
                      glm::dvec4(mouth, 1));
  }();
  builder.cylinder(pose, {0.078, 0.028, 0.105, 28}, enamel(0x55796f), plain(0x55796f));
  builder.patchSettings() = {.coarseness = 1.5, .lightStep = 0.02, .isEmissive = true};
  builder.hollow(pose, {0.0765, 0.027, 0.105, 28}, paintGlow);
}

}  // namespace

void buildMachines(Builder& builder) {
  buildToolbox(builder);
  buildGearMotor(builder);
  buildVise(builder);
  buildLamp(builder);
}

/// A gloved hand around a wrench, its middle at the origin, and the sleeve that leads back to the
/// person at the bench.
void buildArm(Builder& builder) {
  constexpr std::uint32_t kGlove = 0xb98a4e;
  constexpr std::uint32_t kSleeve = 0x45607c;
  // It is lit as above the bench, where it spends most of its time.
  builder.patchSettings() = {.coarseness = 1.8,
                             .lightStep = 0.012,
                             .body = kArm,
                             .litPose = glm::translate(glm::dmat4(1), {0.10, -0.20, 0.22})};
  const glm::dvec3 wrist(0.055, -0.060, 0.018);
  const glm::dvec3 back = glm::normalize(glm::dvec3(0.62, -0.66, 0.30));
  const Painter glove = plain(kGlove);
  builder.box(uprightPose({0.010, -0.006, -0.020}, -44), {0.082, 0.088, 0.040},
              {.other = glove, .bottom = glove});
  // Four fingers bent around the wrench, and the thumb beside them.
  for (int i = 0; i < 4; ++i) {
    const double along = 0.030 - 0.020 * i;
    const glm::dvec3 knuckle(-0.020 + along * 0.70, 0.030 + along * 0.72, 0.010);
    const glm::dvec3 tip = knuckle + glm::dvec3(-0.034, 0.026, -0.026 - 0.002 * i);
    builder.rod(knuckle - glm::dvec3(-0.010, 0.008, 0), tip, 0.0115, 0.0095, 12, glove, glove);
    builder.rod(tip + glm::dvec3(-0.002, 0.002, 0.004), tip + glm::dvec3(0.012, -0.006, -0.020),
                0.0098, 0.0085, 12, glove, glove);
  }
  builder.rod({0.030, -0.020, 0.000}, {-0.028, -0.036, -0.012}, 0.0125, 0.0105, 12, glove, glove);
  builder.rod(wrist - 0.040 * back, wrist + 0.045 * back, 0.034, 0.040, 18,
              ringed(kGlove, 0x8f6835, 0.030F, 0.8F), glove);
  builder.rod(wrist + 0.035 * back, wrist + 0.075 * back, 0.049, 0.050, 20, plain(0x3a526c),
              plain(0x2e4156));
  builder.rod(wrist + 0.070 * back, wrist + 0.95 * back, 0.047, 0.066, 20, cloth(kSleeve),
              plain(0x2e4156));
  // The wrench, lying across the palm.
  builder.box(uprightPose({-0.028, -0.014, -0.030}, 48), {0.21, 0.017, 0.007},
              {.other = steel(), .bottom = steel()});
  builder.cylinder(uprightPose({-0.098, -0.092, -0.031}), {0.022, 0.022, 0.009, 6}, steel(),
                   steel(), steel());
}

}  // namespace pleinair::hal::synthetic
