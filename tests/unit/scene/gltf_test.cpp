// Valid glTF of every supported layout, compared with the specification.
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "hal/image.h"
#include "hal/media/png_file.h"
#include "pipeline/scene/gltf/gltf_file.h"
#include "pipeline/scene/models/model_pose.h"
#include "tests/unit/scene/gltf_builder.h"

namespace pleinair::scene {
namespace {

const std::vector<float> kTriangle{0, 0, 0, 1, 0, 0, 0, 1, 0};  // faces glTF's front, +z

Model parsed(const GltfBuilder& builder) {
  hal::Result<Model> model = parseGltf(builder.bytes(), "test.glb");
  if (!model) throw std::runtime_error(model.error().message());
  return *std::move(model);
}

/// Position of a corner of a part's triangle in the model's frame, at rest.
glm::dvec3 cornerOf(const Model& model, std::size_t part, std::size_t triangle,
                    std::size_t corner) {
  ModelPose pose;
  poseModel(model, std::nullopt, hal::Duration::zero(), pose);
  const Mesh& mesh = model.surfaces[model.parts[part].firstSurface].mesh;
  const std::uint32_t vertex = mesh.triangles[triangle][corner];
  return glm::dvec3(posedVertex(model, model.parts[part], 0, vertex, pose).position);
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LT(glm::distance(a, b), 1e-6) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(Gltf, StandsUpAndLooksToTheReader) {
  GltfBuilder builder;
  builder.addMesh({0, 0, 0, 0, 1, 0, 0, 0, 1}, "flag");
  const Model model = parsed(builder);
  ASSERT_EQ(model.parts.size(), 1u);
  EXPECT_EQ(model.parts[0].name, "flag");
  expectNear(cornerOf(model, 0, 0, 1), {0, 0, 1});   // up
  expectNear(cornerOf(model, 0, 0, 2), {0, -1, 0});  // front
  EXPECT_TRUE(model.notices.empty());
}

TEST(Gltf, ComposesNodesFromTheirParentsDown) {
  GltfBuilder builder;
  builder.addMesh(kTriangle, "leaf");
  builder.root["nodes"][0]["scale"] = {2, 3, 4};
  builder.root["nodes"][0]["translation"] = {1, 0, 0};
  const double half = std::sqrt(0.5);
  builder.root["nodes"].push_back({{"rotation", {0, 0, half, half}},  // 90° about z
                                   {"translation", {0, 0, 5}},
                                   {"children", {0}}});
  builder.root["nodes"].push_back(
      {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 10, 0, 1}}, {"children", {1}}});
  const Model model = parsed(builder);
  // (1,0,0) is scaled to (2,0,0), moved to (3,0,0), turned to (0,3,0), moved to (0,13,5)
  expectNear(cornerOf(model, 0, 0, 1), {0, -5, 13});
  // (0,1,0) likewise: (0,3,0), (1,3,0), (-3,1,0), (-3,11,5)
  expectNear(cornerOf(model, 0, 0, 2), {-3, -5, 11});
}

TEST(Gltf, ShowsTheDefaultScene) {
  GltfBuilder builder;
  builder.addMesh(kTriangle, "first");
  builder.addMesh(kTriangle, "second");
  builder.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  EXPECT_EQ(parsed(builder).parts[0].name, "first");
  builder.root["scene"] = 1;
  const Model second = parsed(builder);
  ASSERT_EQ(second.parts.size(), 1u);
  EXPECT_EQ(second.parts[0].name, "second");
  builder.root.erase("scenes");
  builder.root.erase("scene");
  EXPECT_EQ(parsed(builder).parts.size(), 2u);
}

TEST(Gltf, SharesTheSurfacesOfInstances) {
  GltfBuilder builder;
  builder.addMesh(kTriangle, "a");
  builder.root["nodes"].push_back({{"name", "b"}, {"mesh", 0}, {"translation", {0, 0, 7}}});
  const Model model = parsed(builder);
  EXPECT_EQ(model.surfaces.size(), 1u);
  EXPECT_EQ(model.triangleCount(), 2u);
  EXPECT_EQ(partOfTriangle(model, 0)->name, "a");
  EXPECT_EQ(partOfTriangle(model, 1)->name, "b");
  EXPECT_EQ(partOfTriangle(model, 2), nullptr);
  EXPECT_EQ(findPart(model, "b"), &model.parts[1]);
  expectNear(cornerOf(model, 1, 0, 0), {0, -7, 0});
}

TEST(Gltf, TakesIndicesOfAllTypes) {
  for (const int type : {5121, 5123, 5125}) {
    GltfBuilder builder;
    auto& primitive = builder.addMesh({9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int indices =
        type == 5121   ? builder.addAccessor<std::uint8_t>({1, 2, 3}, "SCALAR", type, 1)
        : type == 5123 ? builder.addAccessor<std::uint16_t>({1, 2, 3}, "SCALAR", type, 1)
                       : builder.addAccessor<std::uint32_t>({1, 2, 3}, "SCALAR", type, 1);
    primitive["indices"] = indices;
    const Model model = parsed(builder);
    ASSERT_EQ(model.triangleCount(), 1u);
    expectNear(cornerOf(model, 0, 0, 1), {1, 0, 0});
  }
}

TEST(Gltf, UnrollsStripsAndFansWithTheirWinding) {
  // a square in z = 0 that faces +z, which becomes −y
  const std::vector<float> strip{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  const std::vector<float> fan{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  for (const auto& [mode, positions] : {std::pair(5, strip), std::pair(6, fan)}) {
    GltfBuilder builder;
    builder.addMesh(positions)["mode"] = mode;
    const Model model = parsed(builder);
    ASSERT_EQ(model.triangleCount(), 2u);
    glm::dvec3 area(0.0);
    for (std::size_t t = 0; t < 2; ++t) {
      const glm::dvec3 a = cornerOf(model, 0, t, 0);
      const glm::dvec3 own =
          0.5 * glm::cross(cornerOf(model, 0, t, 1) - a, cornerOf(model, 0, t, 2) - a);
      expectNear(own, {0, -0.5, 0});
      area += own;
    }
    expectNear(area, {0, -1, 0});
  }
}

TEST(Gltf, LeavesOutTrianglesWithoutArea) {
  GltfBuilder builder;
  builder.addMesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 1, 2, 2, 2});
  EXPECT_EQ(parsed(builder).triangleCount(), 1u);
}

TEST(Gltf, ShadesFlatWhatHasNoNormals) {
  GltfBuilder builder;
  auto& primitive = builder.addMesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  primitive["indices"] = builder.addAccessor<std::uint8_t>({0, 1, 2, 0, 2, 3}, "SCALAR", 5121, 1);
  const Model model = parsed(builder);
  const Mesh& mesh = model.surfaces[0].mesh;
  EXPECT_EQ(mesh.vertices.size(), 6u);
  EXPECT_EQ(mesh.vertices[0].normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.vertices[3].normal, glm::vec3(1, 0, 0));
}

TEST(Gltf, RepairsNormalsWithoutLength) {
  GltfBuilder builder;
  auto& primitive = builder.addMesh(kTriangle);
  primitive["attributes"]["NORMAL"] = builder.addFloats({0, 0, 0, 0, 3, 4, 0, 0, 1}, "VEC3", 3);
  const Mesh mesh = parsed(builder).surfaces[0].mesh;
  EXPECT_EQ(mesh.vertices[0].normal, glm::vec3(0, 0, 1));  // the triangle's normal
  EXPECT_EQ(mesh.vertices[1].normal, glm::vec3(0, 0.6F, 0.8F));
}

TEST(Gltf, ReplacesSparseElements) {
  GltfBuilder builder;
  builder.addMesh(kTriangle);
  const std::vector<std::uint16_t> which{1};
  const std::vector<float> values{5, 0, 0};
  const int indices = builder.addView(which.data(), 2);
  const int replacement = builder.addView(values.data(), 12);
  builder.root["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
      {"values", {{"bufferView", replacement}}}};
  const Model model = parsed(builder);
  expectNear(cornerOf(model, 0, 0, 1), {5, 0, 0});
  expectNear(cornerOf(model, 0, 0, 2), {0, 0, 1});
  // without a bufferView, the other values are zero: no triangle remains
  builder.root["accessors"][0].erase("bufferView");
  EXPECT_EQ(parsed(builder).triangleCount(), 0u);
}

TEST(Gltf, ReadsInterleavedAndQuantizedVertices) {
  GltfBuilder builder;
  // x y z as normalised bytes, and a byte of padding
  builder.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  builder.addMesh(kTriangle);
  const std::vector<std::int8_t> bytes{0, 0, 0, 99, 127, 0, 0, 99, 0, -127, 0, 99};
  const int view = builder.addView(bytes.data(), bytes.size());
  builder.root["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = 4;
  builder.root["accessors"][0] = {{"bufferView", view},
                                  {"componentType", 5120},
                                  {"count", 3},
                                  {"type", "VEC3"},
                                  {"normalized", true}};
  const Model model = parsed(builder);
  expectNear(cornerOf(model, 0, 0, 1), {1, 0, 0});
  expectNear(cornerOf(model, 0, 0, 2), {0, 0, -1});
}

TEST(Gltf, ReadsVertexColoursOfAllTypes) {
  GltfBuilder builder;
  auto& primitive = builder.addMesh(kTriangle);
  const auto colourWith = [&](int accessor) {
    primitive["attributes"]["COLOR_0"] = accessor;
    return parsed(builder).surfaces[0].mesh.vertices[1].colour;
  };
  const std::vector<float> floats{0, 0, 0, 1, 0.5F, 0.25F, 0, 0, 0};
  EXPECT_EQ(colourWith(builder.addFloats(floats, "VEC3", 3)), glm::vec4(1, 0.5F, 0.25F, 1));
  const std::vector<std::uint8_t> bytes{0, 0, 0, 0, 255, 51, 0, 102, 0, 0, 0, 0};
  EXPECT_EQ(colourWith(builder.addAccessor(bytes, "VEC4", 5121, 4, true)),
            glm::vec4(1, 0.2F, 0, 0.4F));
  const std::vector<std::uint16_t> words{0, 0, 0, 0, 65535, 13107, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(colourWith(builder.addAccessor(words, "VEC4", 5123, 4, true)),
            glm::vec4(1, 0.2F, 0, 0));
}

TEST(Gltf, ReadsMaterialsAndTheirTextures) {
  GltfBuilder builder;
  hal::Image picture({.pixelFormat = hal::PixelFormat::kRgba8, .size = {2, 1}});
  const std::vector<std::uint8_t> pixels{255, 0, 0, 255, 0, 128, 255, 64};
  std::ranges::copy(pixels, picture.plane(0).begin());
  const std::vector<std::uint8_t> png = hal::encodePng(picture.view()).value();
  auto& primitive = builder.addMesh(kTriangle);
  primitive["material"] = 0;
  primitive["attributes"]["TEXCOORD_0"] = builder.addFloats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
  builder.root["images"] = {
      {{"bufferView", builder.addView(png.data(), png.size())}, {"mimeType", "image/png"}}};
  builder.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
  builder.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
  nlohmann::json texture = {{"index", 0}};
  texture["extensions"]["KHR_texture_transform"] = {
      {"offset", {0.5, 0.25}}, {"rotation", std::numbers::pi / 2.0}, {"scale", {2, 3}}};
  builder.root["materials"] = {
      {{"name", "tin"},
       {"doubleSided", true},
       {"alphaMode", "MASK"},
       {"alphaCutoff", 0.3},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {1, 0.5, 0.25, 1}}, {"baseColorTexture", texture}}}}};
  const Model model = parsed(builder);
  ASSERT_EQ(model.materials.size(), 1u);
  const Material& material = model.materials[0];
  EXPECT_EQ(material.name, "tin");
  EXPECT_EQ(material.baseColour, glm::vec4(1, 0.5F, 0.25F, 1));
  EXPECT_TRUE(material.isDoubleSided);
  EXPECT_EQ(material.coverageCutoff, 0.3F);
  ASSERT_EQ(material.texture, 0u);
  EXPECT_EQ(model.textures[0].across, TextureEdge::kClamp);
  EXPECT_EQ(model.textures[0].down, TextureEdge::kMirror);
  const auto seen = model.textures[0].picture->view();
  EXPECT_EQ(seen.format.pixelFormat, hal::PixelFormat::kRgba8);
  EXPECT_THAT(seen.row(0, 0), testing::ElementsAreArray(pixels));
  // the extension's formula: scale, rotate (clockwise, since y points down), translate
  const MeshVertex& vertex = model.surfaces[0].mesh.vertices[1];  // (1, 0)
  EXPECT_NEAR(vertex.texture.x, 0.5, 1e-6);
  EXPECT_NEAR(vertex.texture.y, 0.25 - 2.0, 1e-6);
}

TEST(Gltf, MakesEqualTexturesOnce) {
  GltfBuilder builder;
  const hal::Image picture({.pixelFormat = hal::PixelFormat::kRgb8, .size = {2, 1}});
  const std::vector<std::uint8_t> png = hal::encodePng(picture.view()).value();
  builder.root["images"] = {{{"bufferView", builder.addView(png.data(), png.size())}}};
  builder.root["samplers"] = {{{"wrapS", 33071}}, {{"wrapS", 10497}}};
  builder.root["textures"] = {
      {{"source", 0}, {"sampler", 0}}, {{"source", 0}}, {{"source", 0}, {"sampler", 1}}};
  for (int i = 0; i < 3; ++i) {
    builder.addMesh(kTriangle)["material"] = i;
    builder.root["materials"].push_back(
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
  }
  const Model model = parsed(builder);
  ASSERT_EQ(model.textures.size(), 2u);
  EXPECT_EQ(model.textures[0].across, TextureEdge::kClamp);
  EXPECT_EQ(model.materials[0].texture, 0u);
  EXPECT_EQ(model.materials[1].texture, 1u);
  EXPECT_EQ(model.materials[2].texture, 1u);
}

TEST(Gltf, SaysWhatItDoesNotShow) {
  GltfBuilder builder;
  builder.addMesh(kTriangle)["targets"] = {{{"POSITION", 0}, {"COLOR_0", 0}}};
  builder.addMesh(kTriangle)["mode"] = 1;
  builder.root["animations"] = {{{"name", "wave\nbye"},
                                 {"channels", nlohmann::json::array()},
                                 {"samplers", nlohmann::json::array()}}};
  builder.root["materials"] = {{{"name", "glass"}, {"alphaMode", "BLEND"}}};
  builder.root["meshes"][0]["primitives"][0]["material"] = 0;
  EXPECT_THAT(
      parsed(builder).notices,
      testing::ElementsAre("its animations without effect are left out: wave bye",
                           "its morph targets move vertices, but no colours and no textures",
                           "its points and lines are not shown",
                           "drawn opaque or alpha-masked instead of blended: glass"));
}

TEST(Gltf, MayShowNothing) {
  const Model model = parsed(GltfBuilder());
  EXPECT_EQ(model.triangleCount(), 0u);
  EXPECT_EQ(boundingSphere(model).radiusMetres, 0.0);
  EXPECT_THAT(model.notices, testing::ElementsAre("it contains nothing visible"));
}

}  // namespace
}  // namespace pleinair::scene
