#include "tests/oracles/gltf_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

namespace pleinair::oracles {
namespace {

using nlohmann::json;
using Matrix = std::array<double, 16>;  // column-major
using Numbers = std::vector<double>;

constexpr Matrix kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result{};
  for (std::size_t column = 0; column < 4; ++column) {
    for (std::size_t row = 0; row < 4; ++row) {
      for (std::size_t i = 0; i < 4; ++i) {
        result[4 * column + row] += a[4 * i + row] * b[4 * column + i];
      }
    }
  }
  return result;
}

GltfOracle::Point moved(const Matrix& m, const GltfOracle::Point& p) {
  GltfOracle::Point result{};
  for (std::size_t row = 0; row < 3; ++row) {
    result[row] = m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row];
  }
  return result;
}

/// T · R · S (section 3.5.3).
Matrix trs(const Numbers& t, const Numbers& q, const Numbers& s) {
  const double x = q[0];
  const double y = q[1];
  const double z = q[2];
  const double w = q[3];
  Matrix m{1 - 2 * (y * y + z * z),
           2 * (x * y + z * w),
           2 * (x * z - y * w),
           0,
           2 * (x * y - z * w),
           1 - 2 * (x * x + z * z),
           2 * (y * z + x * w),
           0,
           2 * (x * z + y * w),
           2 * (y * z - x * w),
           1 - 2 * (x * x + y * y),
           0,
           t[0],
           t[1],
           t[2],
           1};
  for (std::size_t column = 0; column < 3; ++column) {
    for (std::size_t row = 0; row < 3; ++row) m[4 * column + row] *= s[column];
  }
  return m;
}

Numbers normalised(Numbers q) {
  double squares = 0.0;
  for (const double each : q) squares += each * each;
  for (double& each : q) each /= std::sqrt(squares);
  return q;
}

/// Spherical interpolation, as in appendix C.4.
Numbers slerp(const Numbers& from, const Numbers& to, double t) {
  double dot = 0.0;
  for (std::size_t i = 0; i < 4; ++i) dot += from[i] * to[i];
  const double angle = std::acos(std::min(std::abs(dot), 1.0));
  const double sign = dot < 0.0 ? -1.0 : 1.0;
  Numbers result(4);
  for (std::size_t i = 0; i < 4; ++i) {
    result[i] = angle < 1e-6
                    ? (1.0 - t) * from[i] + t * sign * to[i]
                    : (std::sin(angle * (1.0 - t)) * from[i] + sign * std::sin(angle * t) * to[i]) /
                          std::sin(angle);
  }
  return normalised(result);
}

}  // namespace

struct GltfOracle::File {
  json root;
  std::vector<unsigned char> binary;
  mutable std::map<std::size_t, Matrix> known_;
  mutable std::pair<std::optional<std::size_t>, double> knownAt_;

  explicit File(const std::vector<unsigned char>& glb) {
    std::uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, 4);
    const auto text = glb.begin() + 20;
    root = json::parse(text, text + length);
    const auto rest = static_cast<std::size_t>(20 + length);
    if (rest + 8 < glb.size()) {
      binary.assign(glb.begin() + static_cast<std::ptrdiff_t>(rest) + 8, glb.end());
    }
  }

  /// All elements of an accessor in sequence (section 3.6.2); sparse ones are not supported.
  Numbers numbers(const json& index) const {
    const json& accessor = root["accessors"][index.get<std::size_t>()];
    if (accessor.contains("sparse")) throw std::runtime_error("the oracle knows no sparse ones");
    const json& view = root["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::string type = accessor["type"];
    const std::size_t width =
        type == "SCALAR" ? 1 : (type == "MAT4" ? 16 : static_cast<std::size_t>(type.back() - '0'));
    const int component = accessor["componentType"];
    const std::size_t bytes = component <= 5121 ? 1 : (component <= 5123 ? 2 : 4);
    const std::size_t stride = view.value("byteStride", width * bytes);
    const std::size_t first =
        view.value("byteOffset", std::size_t{0}) + accessor.value("byteOffset", std::size_t{0});
    const bool isFraction = accessor.value("normalized", false);
    Numbers result;
    for (std::size_t i = 0; i < accessor["count"].get<std::size_t>(); ++i) {
      for (std::size_t c = 0; c < width; ++c) {
        result.push_back(number(first + i * stride + c * bytes, component, isFraction));
      }
    }
    return result;
  }

  double number(std::size_t at, int component, bool isFraction) const {
    const auto as = [&](auto value, double most) {
      std::memcpy(&value, binary.data() + at, sizeof(value));
      const auto plain = static_cast<double>(value);
      return isFraction ? std::max(plain / most, -1.0) : plain;
    };
    switch (component) {
      case 5120:
        return as(std::int8_t{}, 127.0);
      case 5121:
        return as(std::uint8_t{}, 255.0);
      case 5122:
        return as(std::int16_t{}, 32767.0);
      case 5123:
        return as(std::uint16_t{}, 65535.0);
      case 5125:
        return as(std::uint32_t{}, 1.0);
      default:
        return as(float{}, 1.0);
    }
  }

  /// The value of a node's property in an animation, if the animation has a channel for it.
  std::optional<Numbers> animated(std::optional<std::size_t> animation, double seconds,
                                  std::size_t node, const std::string& path) const {
    if (!animation) return std::nullopt;
    const json& all = root["animations"][*animation];
    for (const json& channel : all["channels"]) {
      const json& target = channel["target"];
      if (!target.contains("node") || target["node"] != node || target["path"] != path) continue;
      return sampled(all["samplers"][channel["sampler"].get<std::size_t>()], seconds, path);
    }
    return std::nullopt;
  }

  Numbers sampled(const json& sampler, double seconds, const std::string& path) const {
    const Numbers times = numbers(sampler["input"]);
    const Numbers values = numbers(sampler["output"]);
    const std::string kind = sampler.value("interpolation", "LINEAR");
    const std::size_t parts = kind == "CUBICSPLINE" ? 3 : 1;
    const std::size_t width = values.size() / times.size() / parts;
    const auto part = [&](std::size_t key, std::size_t which) {
      const auto first =
          values.begin() + static_cast<std::ptrdiff_t>((parts * key + which) * width);
      return Numbers(first, first + static_cast<std::ptrdiff_t>(width));
    };
    const std::size_t middle = parts == 3 ? 1 : 0;
    const bool isTurn = path == "rotation";
    const auto plain = [&](std::size_t key) {
      return isTurn ? normalised(part(key, middle)) : part(key, middle);
    };
    if (seconds <= times.front()) return plain(0);
    if (seconds >= times.back()) return plain(times.size() - 1);
    std::size_t k = 0;
    while (times[k + 1] <= seconds) ++k;
    const double span = times[k + 1] - times[k];
    const double t = (seconds - times[k]) / span;
    if (kind == "STEP") return plain(k);
    if (kind == "LINEAR" && isTurn) return slerp(plain(k), plain(k + 1), t);
    Numbers result(width);
    for (std::size_t i = 0; i < width; ++i) {
      result[i] = kind == "LINEAR" ? (1.0 - t) * part(k, 0)[i] + t * part(k + 1, 0)[i]
                                   : (2 * t * t * t - 3 * t * t + 1) * part(k, 1)[i] +
                                         span * (t * t * t - 2 * t * t + t) * part(k, 2)[i] +
                                         (-2 * t * t * t + 3 * t * t) * part(k + 1, 1)[i] +
                                         span * (t * t * t - t * t) * part(k + 1, 0)[i];
    }
    return isTurn ? normalised(result) : result;
  }

  Matrix local(std::size_t index, std::optional<std::size_t> animation, double seconds) const {
    const json& node = root["nodes"][index];
    if (node.contains("matrix")) return node["matrix"].get<Matrix>();
    const auto property = [&](const char* path, const Numbers& otherwise) {
      if (auto value = animated(animation, seconds, index, path)) return *value;
      return node.contains(path) ? node[path].get<Numbers>() : otherwise;
    };
    return trs(property("translation", {0, 0, 0}), property("rotation", {0, 0, 0, 1}),
               property("scale", {1, 1, 1}));
  }

  Matrix global(std::size_t index, std::optional<std::size_t> animation, double seconds) const {
    if (knownAt_ != std::pair(animation, seconds)) known_.clear();  // only for speed
    knownAt_ = {animation, seconds};
    if (const auto known = known_.find(index); known != known_.end()) return known->second;
    Matrix result = local(index, animation, seconds);
    for (std::size_t parent = 0; parent < root["nodes"].size(); ++parent) {
      const json& node = root["nodes"][parent];
      if (!node.contains("children")) continue;
      for (const json& child : node["children"]) {
        if (child == index) result = product(global(parent, animation, seconds), result);
      }
    }
    return known_.emplace(index, result).first->second;
  }

  const json& primitive(std::size_t node, std::size_t index) const {
    return root["meshes"][root["nodes"][node]["mesh"].get<std::size_t>()]["primitives"][index];
  }

  /// Positions with morph targets applied (section 3.7.2.2).
  Numbers positions(std::size_t node, std::size_t index, std::optional<std::size_t> animation,
                    double seconds) const {
    const json& shape = primitive(node, index);
    Numbers result = numbers(shape["attributes"]["POSITION"]);
    if (!shape.contains("targets")) return result;
    const json& mesh = root["meshes"][root["nodes"][node]["mesh"].get<std::size_t>()];
    Numbers weights(shape["targets"].size(), 0.0);
    if (mesh.contains("weights")) weights = mesh["weights"].get<Numbers>();
    if (root["nodes"][node].contains("weights")) {
      weights = root["nodes"][node]["weights"].get<Numbers>();
    }
    if (auto moved = animated(animation, seconds, node, "weights")) weights = *moved;
    for (std::size_t target = 0; target < weights.size(); ++target) {
      if (!shape["targets"][target].contains("POSITION")) continue;
      const Numbers moves = numbers(shape["targets"][target]["POSITION"]);
      for (std::size_t i = 0; i < result.size(); ++i) result[i] += weights[target] * moves[i];
    }
    return result;
  }

  /// The matrix that maps each vertex to the root's frame.
  std::vector<Matrix> placements(std::size_t node, const json& attributes, std::size_t vertices,
                                 std::optional<std::size_t> animation, double seconds) const {
    if (!root["nodes"][node].contains("skin")) {
      return std::vector<Matrix>(vertices, global(node, animation, seconds));
    }
    const json& skin = root["skins"][root["nodes"][node]["skin"].get<std::size_t>()];
    const Numbers inverse =
        skin.contains("inverseBindMatrices") ? numbers(skin["inverseBindMatrices"]) : Numbers();
    std::vector<Matrix> joints;
    for (const json& joint : skin["joints"]) {
      Matrix bound = kIdentity;
      if (!inverse.empty()) {
        std::copy_n(inverse.begin() + static_cast<std::ptrdiff_t>(16 * joints.size()), 16,
                    bound.begin());
      }
      joints.push_back(product(global(joint, animation, seconds), bound));
    }
    const Numbers which = numbers(attributes["JOINTS_0"]);
    const Numbers weights = numbers(attributes["WEIGHTS_0"]);
    std::vector<Matrix> result(vertices, Matrix{});
    for (std::size_t vertex = 0; vertex < vertices; ++vertex) {
      double sum = 0.0;
      for (std::size_t c = 0; c < 4; ++c) sum += weights[4 * vertex + c];
      for (std::size_t c = 0; c < 4; ++c) {
        const auto joint = static_cast<std::size_t>(which[4 * vertex + c]);
        for (std::size_t i = 0; i < 16; ++i) {
          result[vertex][i] += weights[4 * vertex + c] / sum * joints[joint][i];
        }
      }
    }
    return result;
  }
};

namespace {

std::vector<unsigned char> bytesOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

GltfOracle::GltfOracle(const std::filesystem::path& glb) : GltfOracle(bytesOf(glb)) {}
GltfOracle::GltfOracle(const std::vector<unsigned char>& glb)
    : file_(std::make_unique<File>(glb)) {}
GltfOracle::~GltfOracle() = default;

std::size_t GltfOracle::animations() const {
  return file_->root.contains("animations") ? file_->root["animations"].size() : 0;
}

double GltfOracle::lastKey(std::size_t animation) const {
  double last = 0.0;
  for (const json& sampler : file_->root["animations"][animation]["samplers"]) {
    last = std::max(last, file_->numbers(sampler["input"]).back());
  }
  return last;
}

std::vector<std::size_t> GltfOracle::shownNodes() const {
  std::vector<std::size_t> nodes;
  for (std::size_t i = 0; i < file_->root["nodes"].size(); ++i) {
    if (file_->root["nodes"][i].contains("mesh")) nodes.push_back(i);
  }
  return nodes;
}

std::string GltfOracle::nodeName(std::size_t node) const {
  const json& shown = file_->root["nodes"][node];
  std::string name = shown.value("name", "");
  if (!name.empty()) return name;
  return file_->root["meshes"][shown["mesh"].get<std::size_t>()].value("name", "");
}

std::size_t GltfOracle::primitives(std::size_t node) const {
  const json& shown = file_->root["nodes"][node];
  return file_->root["meshes"][shown["mesh"].get<std::size_t>()]["primitives"].size();
}

std::vector<GltfOracle::Point> GltfOracle::corners(std::size_t node, std::size_t primitive,
                                                   std::optional<std::size_t> animation,
                                                   double seconds) const {
  const json& shape = file_->primitive(node, primitive);
  const Numbers positions = file_->positions(node, primitive, animation, seconds);
  const std::size_t vertices = positions.size() / 3;
  const auto placements =
      file_->placements(node, shape["attributes"], vertices, animation, seconds);
  Numbers indices(vertices);
  for (std::size_t i = 0; i < vertices; ++i) indices[i] = static_cast<double>(i);
  if (shape.contains("indices")) indices = file_->numbers(shape["indices"]);
  std::vector<Point> corners;
  for (const double index : indices) {
    const auto i = static_cast<std::size_t>(index);
    corners.push_back(
        moved(placements[i], {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]}));
  }
  return corners;
}

GltfOracle::Point GltfOracle::origin(std::size_t node, std::optional<std::size_t> animation,
                                     double seconds) const {
  return moved(file_->global(node, animation, seconds), {0.0, 0.0, 0.0});
}

}  // namespace pleinair::oracles
