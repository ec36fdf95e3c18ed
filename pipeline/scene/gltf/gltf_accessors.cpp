#include "pipeline/scene/gltf/gltf_accessors.h"

#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "config/config_error.h"
#include "pipeline/scene/gltf/gltf_fault.h"
#include "pipeline/scene/gltf/gltf_limits.h"

namespace pleinair::scene::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF's numbers are read as they are");

constexpr std::size_t kMaxStride = 252;  // section 5.11.4

std::size_t bytesOfComponent(int componentType) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

std::size_t componentsOf(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
      return 4;
    case TINYGLTF_TYPE_MAT4:
      return 16;
    default:
      return 0;  // MAT2 and MAT3, which nothing here uses
  }
}

template <class T>
T valueOf(std::span<const std::uint8_t> bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

/// A number of glTF; normalised integers become fractions (section 3.11).
double numberOf(std::span<const std::uint8_t> bytes, int componentType, bool isNormalized) {
  const auto scaled = [&](double value, double max) {
    return isNormalized ? std::max(value / max, -1.0) : value;
  };
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return scaled(valueOf<std::int8_t>(bytes), 127.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return scaled(valueOf<std::uint8_t>(bytes), 255.0);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return scaled(valueOf<std::int16_t>(bytes), 32767.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return scaled(valueOf<std::uint16_t>(bytes), 65535.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return valueOf<std::uint32_t>(bytes);
    default:
      return static_cast<double>(valueOf<float>(bytes));
  }
}

bool isUnsigned(int componentType) {
  return componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

/// Copies `count` elements, packed. `bytes` starts at the first element.
void copyElements(std::span<const std::uint8_t> bytes, std::size_t stride, std::size_t elementBytes,
                  std::size_t count, std::vector<std::uint8_t>& to) {
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(to.data() + i * elementBytes, bytes.data() + i * stride, elementBytes);
  }
}

/// The bytes from `offset` on; checks that they hold `count` elements.
std::span<const std::uint8_t> elementBytesAt(std::span<const std::uint8_t> view,
                                             std::uint64_t offset, std::size_t stride,
                                             std::size_t elementBytes, std::size_t count,
                                             const std::string& name) {
  // none of these is above 2^32, so that nothing overflows
  const std::uint64_t needed = std::uint64_t{stride} * (count - 1) + elementBytes;
  if (offset > view.size() || needed > view.size() - offset) {
    refuse(name, fmt::format("reaches to byte {} + {} of its bufferView, which has {}", offset,
                             needed, view.size()));
  }
  return view.subspan(static_cast<std::size_t>(offset));
}

}  // namespace

Accessors::Elements Accessors::read(int index, const std::string& where) {
  const auto& accessors = structure_.gltf.accessors;
  if (index < 0 || static_cast<std::size_t>(index) >= accessors.size()) {
    refuse(where, fmt::format("there is no accessors[{}]", index));
  }
  const std::string name = fmt::format("accessors[{}]", index);
  const auto unknown = structure_.unknownTypes.find(static_cast<std::size_t>(index));
  if (unknown != structure_.unknownTypes.end()) {
    refuse(name + ".type", "found " + config::quoted(unknown->second));
  }
  const tinygltf::Accessor& accessor = accessors[static_cast<std::size_t>(index)];
  Elements elements{.count = accessor.count,
                    .components = componentsOf(accessor.type),
                    .componentBytes = bytesOfComponent(accessor.componentType),
                    .componentType = accessor.componentType,
                    .isNormalized = accessor.normalized};
  if (elements.componentBytes == 0) refuse(name + ".componentType", "is none of glTF's");
  if (elements.components == 0) refuse(name + ".type", "is not one that is used here");
  const std::size_t max = elements.components == 16 ? kMaxNodes : kMaxVertices;
  if (accessor.count < 1 || accessor.count > max) {
    refuse(name + ".count", fmt::format("found {}", accessor.count),
           fmt::format("from 1 to {}", max));
  }
  numbers_ += elements.count * elements.components;
  if (numbers_ > maxNumbers_) {
    refuse(where, "exceeds the total number of values",
           fmt::format("at most {} in all", maxNumbers_));
  }
  const std::size_t elementBytes = elements.components * elements.componentBytes;
  elements.bytes.resize(elements.count * elementBytes);
  if (accessor.bufferView >= 0) {
    const auto viewIndex = static_cast<std::size_t>(accessor.bufferView);
    const auto view = resources_.bufferView(viewIndex, name + ".bufferView");
    const std::size_t declared = structure_.gltf.bufferViews[viewIndex].byteStride;
    const std::size_t stride = declared == 0 ? elementBytes : declared;
    if (declared != 0 && (declared < elementBytes || declared > kMaxStride)) {
      refuse(fmt::format("bufferViews[{}].byteStride", viewIndex),
             fmt::format("found {}, for elements of {} bytes", declared, elementBytes));
    }
    copyElements(
        elementBytesAt(view, accessor.byteOffset, stride, elementBytes, elements.count, name),
        stride, elementBytes, elements.count, elements.bytes);
  } else if (accessor.byteOffset != 0) {
    refuse(name + ".byteOffset", "is without a bufferView");
  }
  if (accessor.sparse.isSparse) applySparse(accessor, elements, name);
  return elements;
}

void Accessors::applySparse(const tinygltf::Accessor& accessor, Elements& elements,
                            const std::string& name) {
  const auto& sparse = accessor.sparse;
  const std::size_t indexBytes = bytesOfComponent(sparse.indices.componentType);
  if (!isUnsigned(sparse.indices.componentType)) {
    refuse(name + ".sparse.indices.componentType", "is none of glTF's for indices");
  }
  if (sparse.count < 1 || static_cast<std::size_t>(sparse.count) > elements.count) {
    refuse(name + ".sparse.count", fmt::format("found {}, of {}", sparse.count, elements.count));
  }
  if (sparse.indices.bufferView < 0 || sparse.values.bufferView < 0 ||
      sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) {
    refuse(name + ".sparse", "has no valid bufferViews");
  }
  const auto count = static_cast<std::size_t>(sparse.count);
  const std::size_t elementBytes = elements.components * elements.componentBytes;
  const auto part = [&](int view, int offset, std::size_t bytes, const std::string& what) {
    const std::string partName = name + ".sparse." + what;
    return elementBytesAt(resources_.bufferView(static_cast<std::size_t>(view), partName),
                          static_cast<std::uint64_t>(offset), bytes, bytes, count, partName);
  };
  const auto indices =
      part(sparse.indices.bufferView, sparse.indices.byteOffset, indexBytes, "indices");
  const auto values =
      part(sparse.values.bufferView, sparse.values.byteOffset, elementBytes, "values");
  for (std::size_t i = 0; i < count; ++i) {
    const double target =
        numberOf(indices.subspan(i * indexBytes), sparse.indices.componentType, false);
    if (target >= static_cast<double>(elements.count)) {
      refuse(fmt::format("{}.sparse.indices[{}]", name, i),
             fmt::format("found {}, of {}", target, elements.count));
    }
    std::memcpy(elements.bytes.data() + static_cast<std::size_t>(target) * elementBytes,
                values.data() + i * elementBytes, elementBytes);
  }
}

float Accessors::bounded(const Elements& elements, std::size_t element, std::size_t component,
                         int accessor, const std::string& where) {
  const double value = numberOf(elements.component(element, component), elements.componentType,
                                elements.isNormalized);
  if (!(std::abs(value) <= kMaxCoordinate)) {  // rejects NaN too
    refuse(fmt::format("{}: accessors[{}], element {}", where, accessor, element),
           fmt::format("found {}", value), fmt::format("a number of at most {}", kMaxCoordinate));
  }
  return static_cast<float>(value);
}

std::vector<glm::vec4> Accessors::vectors(int accessor, const std::string& where) {
  const Elements elements = read(accessor, where);
  if (elements.components > 4) refuse(where, "is an accessor of matrices");
  std::vector<glm::vec4> result(elements.count, glm::vec4(0.0F, 0.0F, 0.0F, 1.0F));
  for (std::size_t i = 0; i < elements.count; ++i) {
    for (std::size_t c = 0; c < elements.components; ++c) {
      result[i][static_cast<int>(c)] = bounded(elements, i, c, accessor, where);
    }
  }
  return result;
}

std::vector<glm::uvec4> Accessors::integers(int accessor, const std::string& where) {
  const Elements elements = read(accessor, where);
  if (!isUnsigned(elements.componentType) || elements.components > 4) {
    refuse(where, fmt::format("accessors[{}] is not of unsigned integers", accessor));
  }
  std::vector<glm::uvec4> result(elements.count, glm::uvec4(0U));
  for (std::size_t i = 0; i < elements.count; ++i) {
    for (std::size_t c = 0; c < elements.components; ++c) {
      result[i][static_cast<int>(c)] = static_cast<std::uint32_t>(
          numberOf(elements.component(i, c), elements.componentType, false));
    }
  }
  return result;
}

std::vector<float> Accessors::numbers(int accessor, std::size_t components, bool mayBeFractions,
                                      const std::string& where) {
  const Elements elements = read(accessor, where);
  if (elements.components != components) {
    refuse(where, fmt::format("accessors[{}] has elements of {} numbers, not {}", accessor,
                              elements.components, components));
  }
  if (elements.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT &&
      !(mayBeFractions && elements.isNormalized)) {
    refuse(where, fmt::format("accessors[{}] is not of floats{}", accessor,
                              mayBeFractions ? " nor normalised integers" : ""));
  }
  std::vector<float> result;
  result.reserve(elements.count * components);
  for (std::size_t i = 0; i < elements.count; ++i) {
    for (std::size_t c = 0; c < components; ++c) {
      result.push_back(bounded(elements, i, c, accessor, where));
    }
  }
  return result;
}

std::vector<glm::dmat4> Accessors::matrices(int accessor, const std::string& where) {
  const Elements elements = read(accessor, where);
  if (elements.components != 16 || elements.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) {
    refuse(where, fmt::format("accessors[{}] is not of 4x4 floats", accessor));
  }
  std::vector<glm::dmat4> result(elements.count);
  for (std::size_t i = 0; i < elements.count; ++i) {
    for (std::size_t c = 0; c < 16; ++c) {
      const double value = numberOf(elements.component(i, c), elements.componentType, false);
      if (!(std::abs(value) <= kMaxCoordinate)) {
        refuse(where, fmt::format("accessors[{}], matrix {} holds {}", accessor, i, value));
      }
      result[i][static_cast<int>(c / 4)][static_cast<int>(c % 4)] = value;
    }
  }
  return result;
}

}  // namespace pleinair::scene::gltf
