#pragma once

#include <cstddef>
#include <cstdint>

namespace pleinair::scene::gltf {

// What one model may be. A file can come from anywhere; with these, the worst one takes some
// hundred megabytes and a second or two, and is then refused by name.
inline constexpr std::int64_t kMaxFileBytes = 256LL << 20;  ///< the file itself
/// With all that it refers to: files beside it, data: URIs.
inline constexpr std::int64_t kMaxResourceBytes = 256LL << 20;
inline constexpr std::size_t kMaxJsonBytes = std::size_t{64} << 20;
inline constexpr std::size_t kMaxJsonValues = 2'000'000;
inline constexpr int kMaxJsonDepth = 64;
inline constexpr std::size_t kMaxNodes = 20'000;
inline constexpr std::size_t kMaxImages = 256;
inline constexpr int kMaxTextureSide = 4096;  ///< what every GPU that is meant takes
inline constexpr std::int64_t kMaxTexturePixels =
    48'000'000;  ///< of all pictures, and of all textures
inline constexpr std::size_t kMaxSurfaceTriangles = 1'000'000;
inline constexpr std::size_t kMaxVertices = 3'000'000;
/// What reading takes, each time that something is read: the vertices of a mesh that some nodes
/// show with a skin and others without are read twice.
inline constexpr std::size_t kMaxPrimitives = 100'000;
inline constexpr std::size_t kMaxNumbers = 100'000'000;  ///< of accessors
/// Of the keys of all animations: their times and values.
inline constexpr std::size_t kMaxKeyNumbers = 16'000'000;
/// Joints of all parts that skins bend: a matrix each in every pose.
inline constexpr std::size_t kMaxPosedJoints = 65'536;
/// Vertices of meshes, each time that one is shown: as many as corners of triangles can use.
inline constexpr std::size_t kMaxDrawnVertices = 12'582'912;
/// Moves of vertices by morph targets, of positions and normals, in all.
inline constexpr std::size_t kMaxMorphMoves = 16'000'000;
/// Targets times vertices and triangles, each time that a mesh is shown.
inline constexpr std::size_t kMaxDrawnMorphs = 8'000'000;
inline constexpr double kMaxCoordinate = 1e9;

}  // namespace pleinair::scene::gltf
