#include <array>

#include <glm/geometric.hpp>

#include "hal/cameras/synthetic/materials.h"
#include "hal/cameras/synthetic/workbench.h"

namespace pleinair::hal::synthetic {

/// A gloved hand around a wrench, its middle at the origin, and the sleeve it comes out of, which
/// leads back to the one who works there.
void buildArm(Builder& builder) {
  constexpr std::uint32_t kGlove = 0xb98a4e;
  constexpr std::uint32_t kSleeve = 0x45607c;
  builder.finish() = {.coarseness = 1.8, .lightStep = 0.012, .moves = true};
  const glm::dvec3 wrist(0.055, -0.060, 0.018);
  const glm::dvec3 back = glm::normalize(glm::dvec3(0.62, -0.66, 0.30));
  const Painter glove = plain(kGlove);
  builder.box(standing({0.010, -0.006, -0.020}, -44), {0.082, 0.088, 0.040},
              {.other = glove, .bottom = glove});
  // Four fingers bent around what they hold, and the thumb beside them.
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
  builder.box(standing({-0.028, -0.014, -0.030}, 48), {0.21, 0.017, 0.007},
              {.other = steel(), .bottom = steel()});
  builder.cylinder(standing({-0.098, -0.092, -0.031}), {0.022, 0.022, 0.009, 6}, steel(), steel(),
                   steel());
}

}  // namespace pleinair::hal::synthetic
