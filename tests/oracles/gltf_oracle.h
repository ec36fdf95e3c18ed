#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pleinair::oracles {

/// A .glb's animations and skins as glTF 2.0 says them (sections 3.7.3, 3.11, appendix C), straight
/// from its JSON and numbers, with matrices of 16 numbers: nothing of ours is used. For sound files
/// with one buffer, for .glb as Blender and the sample models have it.
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

  /// Nodes that show a mesh, in the file's order of nodes.
  std::vector<std::size_t> shownNodes() const;
  /// Its own, or else its mesh's.
  std::string nodeName(std::size_t node) const;
  std::size_t primitives(std::size_t node) const;

  /// The corners of a primitive's triangles (three each, of mode TRIANGLES) where the node shows
  /// them, in glTF's own axes; at rest without an animation.
  std::vector<Point> corners(std::size_t node, std::size_t primitive,
                             std::optional<std::size_t> animation, double seconds) const;
  /// Where the node's origin is.
  Point origin(std::size_t node, std::optional<std::size_t> animation, double seconds) const;

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace pleinair::oracles
