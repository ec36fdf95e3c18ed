// Broken and hostile glTF: each file is refused with one line that names the place and the problem.
#include <filesystem>
#include <fstream>
#include <functional>

#include <gmock/gmock.h>

#include "hal/media/png_file.h"
#include "pipeline/scene/gltf/gltf_accessors.h"
#include "pipeline/scene/gltf/gltf_fault.h"
#include "pipeline/scene/gltf/gltf_file.h"
#include "pipeline/scene/gltf/gltf_resources.h"
#include "pipeline/scene/gltf/gltf_structure.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/scene/gltf_builder.h"

namespace pleinair::scene {
namespace {

using nlohmann::json;

std::string refusalOf(std::span<const std::uint8_t> bytes) {
  const hal::Result<Model> model = parseGltf(bytes, "m.glb");
  return model ? "(was taken)" : model.error().message();
}

std::string refusalOf(std::string_view text) {
  return refusalOf({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

/// A triangle with a material, for tests to corrupt.
GltfBuilder soundModel() {
  GltfBuilder builder;
  builder.addMesh({0, 0, 0, 1, 0, 0, 0, 1, 0})["material"] = 0;
  builder.root["meshes"][0]["primitives"][0]["indices"] =
      builder.addAccessor<std::uint8_t>({0, 1, 2}, "SCALAR", 5121, 1);
  builder.root["materials"] = {{{"name", "tin"}}};
  builder.root["scenes"] = {{{"nodes", {0}}}};
  return builder;
}

struct Spoiling {
  std::string name;
  std::function<void(json&)> spoil;
  std::string message;
};

class GltfRefusal : public testing::TestWithParam<Spoiling> {};

TEST_P(GltfRefusal, SaysWhereAndWhat) {
  GltfBuilder builder = soundModel();
  EXPECT_EQ(refusalOf(builder.bytes()), "(was taken)");
  GetParam().spoil(builder.root);
  EXPECT_EQ(refusalOf(builder.bytes()), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    All, GltfRefusal,
    testing::Values(
        Spoiling{"Version", [](json& r) { r["asset"]["version"] = "1.0"; },
                 "m.glb: asset.version: found \"1.0\"; version 2.0"},
        Spoiling{"Extension",
                 [](json& r) { r["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
                 "m.glb: extensionsRequired: needs \"KHR_draco_mesh_compression\", which is not "
                 "supported; export without; supported are KHR_mesh_quantization, "
                 "KHR_texture_transform"},
        Spoiling{"Mesh", [](json& r) { r["nodes"][0]["mesh"] = 7; },
                 "m.glb: nodes[0].mesh: there is no meshes[7]"},
        Spoiling{"Child", [](json& r) { r["nodes"][0]["children"] = {3}; },
                 "m.glb: nodes[0].children: there is no nodes[3]"},
        Spoiling{"OwnChild", [](json& r) { r["nodes"][0]["children"] = {0}; },
                 "m.glb: nodes[0]: is below itself"},
        Spoiling{"Circle",
                 [](json& r) {
                   r["nodes"][0]["children"] = {1};
                   r["nodes"].push_back({{"children", {0}}});
                 },
                 "m.glb: nodes[0]: is below itself"},
        Spoiling{"TwoParents",
                 [](json& r) {
                   r["nodes"].push_back({{"children", {0}}});
                   r["nodes"].push_back({{"children", {0}}});
                 },
                 "m.glb: nodes[2].children: nodes[0] is a child of nodes[1] already"},
        Spoiling{"Scene", [](json& r) { r["scene"] = 4; }, "m.glb: scene: there is no scenes[4]"},
        Spoiling{"SceneNode", [](json& r) { r["scenes"][0]["nodes"] = {-3}; },
                 "m.glb: scenes[0].nodes: there is no nodes[-3]"},
        Spoiling{"Rotation",
                 [](json& r) {
                   r["nodes"][0]["rotation"] = {0, 0, 0, 0};
                 },
                 "m.glb: nodes[0].rotation: is no rotation"},
        Spoiling{"ShortMatrix",
                 [](json& r) {
                   r["nodes"][0]["matrix"] = {1, 2, 3};
                 },
                 "m.glb: nodes[0].matrix: has 3 numbers, not 16"},
        Spoiling{"HugeScale",
                 [](json& r) {
                   r["nodes"][0]["scale"] = {1e300, 1, 1};
                 },
                 "m.glb: nodes[0].scale: found 1e+300; numbers of at most 1000000000"},
        Spoiling{"TowerOfScales",
                 [](json& r) {
                   r["nodes"][0]["scale"] = {1e6, 1, 1};
                   r["nodes"].push_back({{"scale", {1e6, 1, 1}}, {"children", {0}}});
                   r["scenes"][0]["nodes"] = {1};
                 },
                 "m.glb: nodes[0]: is out of range after its parents' transforms"},
        Spoiling{"Material", [](json& r) { r["meshes"][0]["primitives"][0]["material"] = 1; },
                 "m.glb: meshes[0].primitives[0].material: there is no materials[1]"},
        Spoiling{"Texture",
                 [](json& r) {
                   r["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 2;
                 },
                 "m.glb: materials[0].pbrMetallicRoughness.baseColorTexture.index: there is no "
                 "textures[2]"},
        Spoiling{"Accessor",
                 [](json& r) { r["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 9; },
                 "m.glb: meshes[0].primitives[0].attributes.POSITION: there is no accessors[9]"},
        Spoiling{"Index", [](json& r) { r["accessors"][0]["count"] = 2; },
                 "m.glb: meshes[0].primitives[0].indices[2]: found 2, of 2 vertices"},
        Spoiling{"FloatIndices", [](json& r) { r["meshes"][0]["primitives"][0]["indices"] = 0; },
                 "m.glb: meshes[0].primitives[0].indices: accessors[0] is not of unsigned "
                 "integers"},
        Spoiling{"Overrun", [](json& r) { r["accessors"][0]["count"] = 4; },
                 "m.glb: accessors[0]: reaches to byte 0 + 48 of its bufferView, which has 36"},
        Spoiling{"Offset", [](json& r) { r["accessors"][0]["byteOffset"] = 4; },
                 "m.glb: accessors[0]: reaches to byte 4 + 36 of its bufferView, which has 36"},
        Spoiling{"ViewOverrun", [](json& r) { r["bufferViews"][0]["byteLength"] = 4000000000U; },
                 "m.glb: bufferViews[0]: reaches to byte 0 + 4000000000 of buffers[0], which has "
                 "39"},
        Spoiling{"HugeCount",
                 [](json& r) {
                   r["accessors"][0]["count"] = 4000000000U;
                   r["accessors"][0].erase("bufferView");
                 },
                 "m.glb: accessors[0].count: found 4000000000; from 1 to 3000000"},
        Spoiling{"Stride", [](json& r) { r["bufferViews"][0]["byteStride"] = 8; },
                 "m.glb: bufferViews[0].byteStride: found 8, for elements of 12 bytes"},
        Spoiling{"View", [](json& r) { r["accessors"][0]["bufferView"] = 5; },
                 "m.glb: accessors[0].bufferView: there is no bufferViews[5]"},
        Spoiling{"Buffer", [](json& r) { r["bufferViews"][0]["buffer"] = 5; },
                 "m.glb: bufferViews[0].buffer: there is no buffers[5]"},
        Spoiling{"BufferLength",
                 [](json& r) {
                   r["buffers"] = {{{"byteLength", 99}}};
                 },
                 "m.glb: buffers[0].byteLength: found 99, but it has 40 bytes"},
        Spoiling{"UsedUnknownType", [](json& r) { r["accessors"][0]["type"] = "VEC9"; },
                 "m.glb: accessors[0].type: found \"VEC9\""},
        Spoiling{"Skin", [](json& r) { r["nodes"][0]["skin"] = 1; },
                 "m.glb: nodes[0].skin: there is no skins[1]"},
        Spoiling{"Joints",
                 [](json& r) {
                   r["nodes"][0]["skin"] = 0;
                   r["skins"] = {{{"joints", {0, 0}}}};
                 },
                 "m.glb: skins[0].joints: has 2, of 1 nodes"},
        Spoiling{"Mode", [](json& r) { r["meshes"][0]["primitives"][0]["mode"] = 8; },
                 "m.glb: meshes[0].primitives[0].mode: is none of glTF's"}),
    [](const auto& instance) { return instance.param.name; });

TEST(GltfRefusals, NameNumbersThatAreNone) {
  GltfBuilder builder;
  builder.addMesh({0, 0, 0, 1, 0, 0, 0, std::nanf(""), 0});
  EXPECT_EQ(refusalOf(builder.bytes()),
            "m.glb: meshes[0].primitives[0].attributes.POSITION: accessors[0], element 2: found "
            "nan; a number of at most 1000000000");
}

TEST(GltfRefusals, BoundWhatInstancesDraw) {
  GltfBuilder builder;
  std::vector<float> positions;
  for (int i = 0; i < 1000; ++i) positions.insert(positions.end(), {0, 0, 0, 1, 0, 0, 0, 1, 0});
  builder.addMesh(positions);
  for (int i = 0; i < 4200; ++i) builder.root["nodes"].push_back({{"mesh", 0}});
  EXPECT_EQ(refusalOf(builder.bytes()),
            "m.glb: nodes[4194]: exceeds the total number of triangles; at most 4194304 drawn");
}

/// Hardly any vertices are drawn, but each node that shows the mesh processes all of them.
TEST(GltfRefusals, BoundTheVerticesThatInstancesShow) {
  GltfBuilder builder;
  std::vector<float> positions(std::size_t{3} * 630'000, 0.0F);
  positions[3] = positions[7] = 1.0F;
  json& primitive = builder.addMesh(positions);
  primitive["attributes"]["NORMAL"] = primitive["attributes"]["POSITION"];
  primitive["indices"] = builder.addAccessor<std::uint8_t>({0, 1, 2}, "SCALAR", 5121, 1);
  for (int i = 0; i < 20; ++i) builder.root["nodes"].push_back({{"mesh", 0}});
  EXPECT_EQ(
      refusalOf(builder.bytes()),
      "m.glb: nodes[19]: exceeds the total number of shown vertices; at most 12582912 in all");
}

TEST(GltfRefusals, BoundPrimitives) {
  GltfBuilder builder;
  const json empty = {{"attributes", json::object()}};
  builder.root["meshes"] = {{{"primitives", json(50'001, empty)}}};
  builder.root["skins"] = {{{"joints", {0}}}};
  // shared, so read once; with a skin, read a second time
  builder.root["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}}, {{"mesh", 0}, {"skin", 0}}};
  EXPECT_EQ(refusalOf(builder.bytes()),
            "m.glb: meshes[0]: exceeds the total number of primitives; at most 100000 in all");
}

TEST(GltfRefusals, BoundWhatAccessorsMakeToRead) {
  const gltf::Structure structure = gltf::readStructure(
      R"({"asset":{"version":"2.0"},"accessors":[{"componentType":5126,"count":3,"type":"VEC4"}]})");
  gltf::Resources resources(structure, std::nullopt, std::nullopt);
  gltf::Accessors accessors(structure, resources, 24);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(accessors.vectors(0, "here").size(), 3u);
  try {
    accessors.vectors(0, "here");
    FAIL() << "nothing thrown";
  } catch (const gltf::Fault& fault) {
    EXPECT_STREQ(fault.what(), "here: exceeds the total number of values");
    EXPECT_EQ(fault.remedy(), "at most 24 in all");
  }
}

TEST(GltfRefusals, BoundTexturesThatShareAPicture) {
  GltfBuilder builder = soundModel();
  const hal::Image picture({.pixelFormat = hal::PixelFormat::kRgb8, .size = {2400, 2240}});
  const std::vector<std::uint8_t> png = hal::encodePng(picture.view()).value();
  builder.root["images"] = {{{"bufferView", builder.addView(png.data(), png.size())}}};
  const json primitive = builder.root["meshes"][0]["primitives"][0];
  builder.root["meshes"][0]["primitives"] = json::array();
  builder.root["materials"] = json::array();
  for (const int across : {10497, 33071, 33648}) {
    for (const int down : {10497, 33071, 33648}) {
      const std::size_t index = builder.root["materials"].size();
      builder.root["samplers"].push_back({{"wrapS", across}, {"wrapT", down}});
      builder.root["textures"].push_back({{"source", 0}, {"sampler", index}});
      builder.root["materials"].push_back(
          {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", index}}}}}});
      builder.root["meshes"][0]["primitives"].push_back(primitive);
      builder.root["meshes"][0]["primitives"].back()["material"] = index;
    }
  }
  EXPECT_EQ(refusalOf(builder.bytes()),
            "m.glb: textures[8]: exceeds the total number of texture pixels; at most 48 Mpx "
            "in all");
}

TEST(GltfRefusals, BoundTheJson) {
  const std::string deep = "{\"asset\":" + std::string(100'000, '[');
  EXPECT_EQ(refusalOf(deep), "m.glb: its JSON is nested more than 64 levels deep");
  std::string wide = "{\"extras\":[";
  for (int i = 0; i < 2'000'001; ++i) wide += "0,";
  EXPECT_EQ(refusalOf(wide), "m.glb: its JSON has more than 2000000 values");
  EXPECT_THAT(refusalOf("{\"asset\":1e999}"), testing::StartsWith("m.glb: its JSON is broken: "));
  EXPECT_THAT(refusalOf("{\"asset\": \x7f\n}"), testing::Not(testing::HasSubstr("\x7f")));
  const std::string quoted = refusalOf("{\"asset\": \"" + std::string(100'000, 'a') + "\x01\"}");
  EXPECT_THAT(quoted, testing::StartsWith("m.glb: its JSON is broken: "));
  EXPECT_LT(quoted.size(), 300u);
  EXPECT_EQ(refusalOf("solid cube"), "m.glb: is not glTF; give a .glb or .gltf file of version 2");
}

TEST(GltfRefusals, BoundPicturesBeforeTheyAreDecoded) {
  GltfBuilder builder = soundModel();
  // a PNG's signature and header: 4097 × 1, 8-bit RGB
  const std::vector<std::uint8_t> header{0x89, 'P', 'N', 'G', 13,  10, 26, 10,   0, 0, 0,
                                         13,   'I', 'H', 'D', 'R', 0,  0,  0x10, 1, 0, 0,
                                         0,    1,   8,   2,   0,   0,  0,  0,    0, 0, 0};
  builder.root["images"] = {{{"bufferView", builder.addView(header.data(), header.size())}}};
  builder.root["textures"] = {{{"source", 0}}};
  builder.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
  EXPECT_EQ(refusalOf(builder.bytes()),
            "m.glb: images[0]: has 4097x1 px; at most 4096 px a side, and 48 Mpx in all pictures "
            "together");
}

class GltfFiles : public testing::Test {
 protected:
  void write(const std::filesystem::path& path, std::string_view text) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  std::string readWithBuffer(const std::string& uri) {
    const json root = {
        {"asset", {{"version", "2.0"}}},
        {"buffers", {{{"byteLength", 36}, {"uri", uri}}}},
        {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
        {"accessors",
         {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}}},
        {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
        {"nodes", {{{"mesh", 0}}}}};
    write(folder_.path() / "models/m.gltf", root.dump());
    const auto model = readGltf(folder_.path() / "models/m.gltf");
    return model ? "(was taken)" : model.error().message();
  }
  support::TemporaryFolder folder_;
};

TEST_F(GltfFiles, ComeFromTheModelsFolder) {
  write(folder_.path() / "models/m.bin", std::string(36, '\0'));
  write(folder_.path() / "models/parts/a b.bin", std::string(36, '\0'));
  EXPECT_EQ(readWithBuffer("m.bin"), "(was taken)");
  EXPECT_EQ(readWithBuffer("parts/a%20b.bin"), "(was taken)");
  EXPECT_EQ(readWithBuffer("./m.bin"), "(was taken)");
}

TEST_F(GltfFiles, OutsideTheModelsFolderAreNeverOpened) {
  write(folder_.path() / "secret.bin", std::string(36, '\0'));
  write(folder_.path() / "models-too/secret.bin", std::string(36, '\0'));
  const std::string absolute = (folder_.path() / "secret.bin").string();
  for (const std::string& uri :
       {std::string("../secret.bin"), std::string("x/../../secret.bin"),
        std::string("%2e%2e/secret.bin"), std::string("..%2fsecret.bin"), absolute,
        "file://" + absolute, std::string("http://example.com/a.bin"), std::string("a\\b.bin"),
        std::string("../models-too/secret.bin"), std::string("m.bin%00.png"), std::string()}) {
    EXPECT_THAT(readWithBuffer(uri),
                testing::EndsWith("; a file in the model's folder, or a data: URI"))
        << uri;
  }
}

TEST_F(GltfFiles, AreNotReachedThroughLinks) {
  write(folder_.path() / "secret.bin", std::string(36, '\0'));
  std::filesystem::create_directories(folder_.path() / "models");
  std::filesystem::create_symlink("../secret.bin", folder_.path() / "models/link.bin");
  std::filesystem::create_directory_symlink("..", folder_.path() / "models/up");
  EXPECT_THAT(readWithBuffer("link.bin"), testing::HasSubstr("a link out of the model's folder"));
  EXPECT_THAT(readWithBuffer("up/secret.bin"),
              testing::HasSubstr("a link out of the model's folder"));
}

TEST_F(GltfFiles, ThatAreMissingAreNamed) {
  EXPECT_THAT(readWithBuffer("gone.bin"),
              testing::HasSubstr("buffers[0].uri: found \"gone.bin\", which cannot be opened: No "
                                 "such file or directory"));
  EXPECT_THAT(readGltf(folder_.path() / "gone.glb").error().message(),
              testing::HasSubstr("gone.glb"));
}

TEST(DataUri, GivesItsBytes) {
  const auto text = [](std::string_view uri) {
    const auto bytes = gltf::bytesOfDataUri(uri, "x");
    return std::string(bytes.begin(), bytes.end());
  };
  EXPECT_EQ(text("data:application/octet-stream;base64,TWFu"), "Man");
  EXPECT_EQ(text("data:;base64,TWE="), "Ma");
  EXPECT_EQ(text("data:;base64,TQ=="), "M");
  EXPECT_EQ(text("data:;base64,TQ"), "M");
  EXPECT_EQ(text("data:,a%20b"), "a b");
  EXPECT_EQ(text("data:;base64,"), "");
  for (const std::string_view broken : {"data:;base64,T", "data:;base64,TW F", "data:;base64,TQ===",
                                        "data:;base64,T=Fu", "data:", "data:,%2"}) {
    EXPECT_ANY_THROW(gltf::bytesOfDataUri(broken, "x")) << broken;
  }
}

}  // namespace
}  // namespace pleinair::scene
