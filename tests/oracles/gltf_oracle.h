#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pleinair::oracles {

/// An independent reading of a .glb's animations and skins by glTF 2.0 (sections 3.7.3, 3.11,
/// appendix C), from its JSON and numbers; it shares no code with the product. For valid .glb files
/// with one buffer, as Blender and the sample models have them.
class GltfOracle {
 public:
  using Point = std::array<double, 3>;

  explicit GltfOracle(const std::filesystem::path& glb);
  explicit GltfOracle(const std::vector<unsigned char>& glb);
  GltfOracle(const GltfOracle&) = delete;
  GltfOracle& operator=(const GltfOracle&) = delete;
  ~GltfOracle();

  std::size_t animations() const;
  double lastKey(std::size_t animation) const;

  /// The nodes with a mesh, in the file's order.
  std::vector<std::size_t> shownNodes() const;
  /// The node's own name, else its mesh's.
  std::string nodeName(std::size_t node) const;
  std::size_t primitives(std::size_t node) const;

  /// The corners of a primitive's triangles (three each, of mode TRIANGLES) at a node, in glTF's
  /// own axes; at rest without an animation.
  std::vector<Point> corners(std::size_t node, std::size_t primitive,
                             std::optional<std::size_t> animation, double seconds) const;
  /// The position of the node's origin.
  Point origin(std::size_t node, std::optional<std::size_t> animation, double seconds) const;

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace pleinair::oracles
