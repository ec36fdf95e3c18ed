#include "pipeline/gpu/frames/ycbcr.h"

#include <glm/matrix.hpp>

#include "hal/linear_light.h"

namespace pleinair::gpu {

YcbcrConversion ycbcrConversion(hal::ColorEncoding encoding) {
  const hal::LumaWeights weights = hal::lumaWeights(encoding.matrix);
  const auto kr = static_cast<float>(weights.red);
  const auto kb = static_cast<float>(weights.blue);
  const float kg = 1.0F - kr - kb;
  const bool limited = encoding.range == hal::ColorRange::kLimited;
  const float lumaScale = limited ? 255.0F / 219.0F : 1.0F;
  const float chromaScale = limited ? 255.0F / 224.0F : 1.0F;
  const float redFromCr = 2.0F * (1.0F - kr) * chromaScale;
  const float blueFromCb = 2.0F * (1.0F - kb) * chromaScale;
  YcbcrConversion result{};
  result.toRgb = glm::mat3(  // columns: Y, Cb, Cr
      glm::vec3(lumaScale), glm::vec3(0.0F, -blueFromCb * kb / kg, blueFromCb),
      glm::vec3(redFromCr, -redFromCr * kr / kg, 0.0F));
  result.fromRgb = glm::inverse(result.toRgb);
  result.offset = glm::vec3(limited ? 16.0F / 255.0F : 0.0F, 128.0F / 255.0F, 128.0F / 255.0F);
  return result;
}

bool isChromaLeftSited(hal::ColorEncoding encoding) {
  return encoding.range == hal::ColorRange::kLimited;
}

}  // namespace pleinair::gpu
