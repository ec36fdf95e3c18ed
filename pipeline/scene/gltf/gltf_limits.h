#pragma once

#include <cstddef>
#include <cstdint>

namespace pleinair::scene::gltf {

// Limits of one model. A file can come from anywhere; with these limits, the worst one takes some
// hundred megabytes and a second or two and is then refused with an error.
inline constexpr std::int64_t kMaxFileBytes = 256LL << 20;  ///< the file itself
/// The file with all files beside it and data: URIs.
inline constexpr std::int64_t kMaxResourceBytes = 256LL << 20;
inline constexpr std::size_t kMaxJsonBytes = std::size_t{64} << 20;
inline constexpr std::size_t kMaxJsonValues = 2'000'000;
inline constexpr int kMaxJsonDepth = 64;
inline constexpr std::size_t kMaxNodes = 20'000;
inline constexpr std::size_t kMaxImages = 256;
inline constexpr int kMaxTextureSide = 4096;  ///< supported by every GPU that this project targets
inline constexpr std::int64_t kMaxTexturePixels =
    48'000'000;  ///< of all images, and of all textures
inline constexpr std::size_t kMaxSurfaceTriangles = 1'000'000;
inline constexpr std::size_t kMaxVertices = 3'000'000;
/// Limits of reading, repeated reads included: a mesh that some nodes show with a skin and others
/// without counts twice.
inline constexpr std::size_t kMaxPrimitives = 100'000;
inline constexpr std::size_t kMaxNumbers = 100'000'000;  ///< of accessors
/// Times and values of the keys of all animations.
inline constexpr std::size_t kMaxKeyNumbers = 16'000'000;
/// Joints of all skinned parts: each pose has one matrix per joint.
inline constexpr std::size_t kMaxPosedJoints = 65'536;
/// Vertices of meshes, counted each time one is shown: as many as corners of triangles can use.
inline constexpr std::size_t kMaxDrawnVertices = 12'582'912;
/// Positions and normals moved by all morph targets, in total.
inline constexpr std::size_t kMaxMorphMoves = 16'000'000;
/// Number of targets times vertices and triangles, counted each time a mesh is shown.
inline constexpr std::size_t kMaxDrawnMorphs = 8'000'000;
inline constexpr double kMaxCoordinate = 1e9;

}  // namespace pleinair::scene::gltf
