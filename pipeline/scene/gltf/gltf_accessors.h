#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "pipeline/scene/gltf/gltf_limits.h"
#include "pipeline/scene/gltf/gltf_resources.h"
#include "pipeline/scene/gltf/gltf_structure.h"

namespace pleinair::scene::gltf {

/// Reads accessors of any layout, sparse ones included. `where` names the JSON element that refers
/// to the accessor. All functions throw Fault for values out of range, beyond the limits, or not
/// finite.
class Accessors {
 public:
  /// Reads at most `maxNumbers` numbers in total, repeated reads included.
  Accessors(const Structure& structure, Resources& resources, std::size_t maxNumbers = kMaxNumbers)
      : structure_(structure), resources_(resources), maxNumbers_(maxNumbers) {}

  /// Vectors of 1 to 4 numbers. A missing component is 0, or 1 if it is the fourth. Normalised
  /// integers become fractions.
  std::vector<glm::vec4> vectors(int accessor, const std::string& where);
  /// Unsigned integers: indices, or one component each of joints.
  std::vector<glm::uvec4> integers(int accessor, const std::string& where);
  /// `components` numbers per element, one after another: floats or, with `mayBeFractions`,
  /// normalised integers as fractions.
  std::vector<float> numbers(int accessor, std::size_t components, bool mayBeFractions,
                             const std::string& where);
  /// 4 × 4 floats.
  std::vector<glm::dmat4> matrices(int accessor, const std::string& where);

 private:
  struct Elements {
    std::vector<std::uint8_t> bytes;  ///< packed
    std::size_t count = 0;
    std::size_t components = 0;
    std::size_t componentBytes = 0;
    int componentType = 0;
    bool isNormalized = false;
    std::span<const std::uint8_t> component(std::size_t element, std::size_t index) const {
      return std::span(bytes).subspan((element * components + index) * componentBytes,
                                      componentBytes);
    }
  };
  Elements read(int accessor, const std::string& where);
  static float bounded(const Elements& elements, std::size_t element, std::size_t component,
                       int accessor, const std::string& where);
  void applySparse(const tinygltf::Accessor& accessor, Elements& elements, const std::string& name);

  const Structure& structure_;
  Resources& resources_;
  std::size_t maxNumbers_;
  std::size_t numbers_ = 0;  ///< number of numbers read so far
};

}  // namespace pleinair::scene::gltf
