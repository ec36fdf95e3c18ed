// STL and OBJ files, and the keys that say their units and axes.
#include "pipeline/scene/meshes/mesh_file.h"

#include <cmath>
#include <fstream>
#include <set>
#include <string>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/config_error.h"
#include "pipeline/scene/description/scene_file.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::scene {
namespace {

using testing::HasSubstr;

/// A box from 0 to 40 x 30 x 20, as CAD programs write it.
std::string boxStl() {
  const glm::vec3 size(40, 30, 20);
  std::string text = "solid box\n";
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {0.0F, 1.0F}) {
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      const auto corner = [&](float a, float b) {
        glm::vec3 at(0.0F);
        at[axis] = side * size[axis];
        at[u] = a * size[u];
        at[v] = b * size[v];
        return "vertex " + std::to_string(at.x) + " " + std::to_string(at.y) + " " +
               std::to_string(at.z) + "\n";
      };
      const bool isFront = side > 0.5F;
      const std::string first = isFront ? corner(0, 0) + corner(1, 0) + corner(1, 1)
                                        : corner(0, 0) + corner(1, 1) + corner(1, 0);
      const std::string second = isFront ? corner(0, 0) + corner(1, 1) + corner(0, 1)
                                         : corner(0, 0) + corner(0, 1) + corner(1, 1);
      for (const std::string& triangle : {first, second}) {
        text += "facet normal 0 0 0\nouter loop\n" + triangle + "endloop\nendfacet\n";
      }
    }
  }
  return text + "endsolid box\n";
}

class MeshFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
    return folder_.path() / name;
  }
  std::string problemOf(const std::filesystem::path& path) const {
    const auto model = readMeshFile(path);
    return model ? "(none)" : model.error().message();
  }
  Scene sceneWith(const std::string& keys) const {
    return parseScene("[[tag]]\nid = 0\nedge_m = 0.1\n[[model]]\nattach = \"tag:0\"\n" + keys,
                      "scene.toml", folder_.path());
  }
  std::string refusalOf(const std::string& keys) const {
    try {
      sceneWith(keys);
    } catch (const config::ConfigError& error) {
      return error.what();
    }
    return "(nothing thrown)";
  }

  support::TemporaryFolder folder_;
};

TEST_F(MeshFile, OfStlHasCreasesAndOutwardNormals) {
  const auto model = readMeshFile(write("box.STL", boxStl()));
  ASSERT_TRUE(model) << model.error().message();
  ASSERT_EQ(model->triangleCount(), 12U);
  const Mesh& mesh = model->surfaces.at(0).mesh;
  EXPECT_EQ(mesh.vertices.size(), 24U) << "four for each side, since its edges are creases";
  const glm::vec3 centre(20, 15, 10);
  for (const auto& triangle : mesh.triangles) {
    const MeshVertex& vertex = mesh.vertices[triangle[0]];
    EXPECT_NEAR(glm::length(vertex.normal), 1.0F, 1e-5F);
    EXPECT_GT(glm::dot(vertex.normal, vertex.position - centre), 0.0F);
  }
}

TEST_F(MeshFile, OfStlIsSmoothWhereItIsRound) {
  // A tube of 48 sides: neighbours differ by 7.5°.
  std::string text = "solid tube\n";
  const auto at = [](int i, float z) {
    const float angle = static_cast<float>(i) * 6.2831853F / 48.0F;
    return "vertex " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) +
           " " + std::to_string(z) + "\n";
  };
  for (int i = 0; i < 48; ++i) {
    const int next = (i + 1) % 48;
    for (const std::string& triangle :
         {at(i, 0) + at(next, 0) + at(next, 1), at(i, 0) + at(next, 1) + at(i, 1)}) {
      text += "facet normal 0 0 0\nouter loop\n" + triangle + "endloop\nendfacet\n";
    }
  }
  const auto model = readMeshFile(write("tube.stl", text + "endsolid tube\n"));
  ASSERT_TRUE(model) << model.error().message();
  for (const MeshVertex& vertex : model->surfaces.at(0).mesh.vertices) {
    const glm::vec3 outward = glm::normalize(glm::vec3(vertex.position.x, vertex.position.y, 0.0F));
    EXPECT_GT(glm::dot(vertex.normal, outward), 0.999F);
  }
}

TEST_F(MeshFile, OfObjHasItsPartsAndColours) {
  write("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\nmap_Kd wood.png\n");
  const auto model = readMeshFile(
      write("two.obj",
            "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no lid\nusemtl red\nf 1 2 3\n"
            "o base\nusemtl blue\nf 1 3 4\nf 1 2 4\n"));
  ASSERT_TRUE(model) << model.error().message();
  std::set<std::string> names;
  for (const ModelPart& part : model->parts) names.insert(part.name);
  EXPECT_THAT(names, testing::ElementsAre("base", "lid"));
  const ModelPart* lid = findPart(*model, "lid");
  const Material& red = model->materials[model->surfaces[lid->firstSurface].material];
  EXPECT_EQ(red.baseColour, glm::vec4(1, 0, 0, 1));
  EXPECT_THAT(model->notices, testing::Contains(HasSubstr("textures are not shown")));
}

TEST_F(MeshFile, OpensNoFileElsewhere) {
  const support::TemporaryFolder other;
  std::ofstream(other.path() / "secret.mtl") << "newmtl red\nKd 1 0 0\n";
  const auto model =
      readMeshFile(write("a.obj", "mtllib " + (other.path() / "secret.mtl").string() +
                                      "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n"));
  ASSERT_TRUE(model) << model.error().message();
  EXPECT_NE(model->materials[model->surfaces.at(0).material].baseColour, glm::vec4(1, 0, 0, 1));
}

TEST_F(MeshFile, ThatIsBrokenIsRefusedInOneLine) {
  EXPECT_THAT(problemOf(write("a.stl", "no model")), HasSubstr("a.stl: "));
  EXPECT_THAT(problemOf(write("b.stl", "")), HasSubstr("b.stl: "));
  EXPECT_THAT(problemOf(write("c.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")), HasSubstr("c.obj: "));
  EXPECT_THAT(problemOf(write("d.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n")),
              HasSubstr("d.obj: "));
  EXPECT_THAT(problemOf(folder_.path() / "absent.stl"), HasSubstr("absent.stl"));
  for (const char* name : {"a.stl", "b.stl", "c.obj", "d.obj", "absent.stl"}) {
    EXPECT_EQ(problemOf(folder_.path() / name).find('\n'), std::string::npos) << name;
  }
}

TEST_F(MeshFile, StandsInItsUnitsAndUpright) {
  write("box.stl", boxStl());
  write("box.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
  const auto corner = [](const Scene& scene, const glm::dvec3& at) {
    return glm::dvec3(scene.models.at(0).attachFromModel * glm::dvec4(at, 1.0));
  };
  const auto expectAt = [](const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_LT(glm::distance(a, b), 1e-9) << a.x << ' ' << a.y << ' ' << a.z;
  };
  expectAt(corner(sceneWith("source = \"box.stl\"\nunits = \"mm\"\n"), {40, 30, 20}),
           {0.04, 0.03, 0.02});
  expectAt(corner(sceneWith("source = \"box.stl\"\nunits = \"in\"\nscale = 2\n"), {1, 0, 0}),
           {0.0508, 0, 0});
  expectAt(corner(sceneWith("source = \"box.stl\"\nunits = \"m\"\nup = \"y\"\n"), {0, 2, 0}),
           {0, 0, 2});
  expectAt(corner(sceneWith("source = \"box.obj\"\nunits = \"cm\"\n"), {0, 2, 0}), {0, 0, 0.02});
  expectAt(corner(sceneWith("source = \"box.obj\"\nunits = \"cm\"\nup = \"z\"\n"), {0, 2, 0}),
           {0, 0.02, 0});
}

TEST_F(MeshFile, GuessesNoUnits) {
  write("box.stl", boxStl());
  EXPECT_THAT(refusalOf("source = \"box.stl\"\n"),
              HasSubstr("units: is missing, and such files do not say theirs"));
  EXPECT_THAT(refusalOf("source = \"box.stl\"\nunits = \"feet\"\n"), HasSubstr("m, mm, cm, in"));
  EXPECT_THAT(refusalOf("source = \"builtin:box\"\nunits = \"mm\"\n"), HasSubstr("unknown key"));
}

TEST_F(MeshFile, AdvisesAScaleBesideTheUnits) {
  write("box.stl", boxStl());
  const Scene scene = sceneWith("source = \"box.stl\"\nunits = \"m\"\n");
  EXPECT_THAT(
      scene.notices,
      testing::Contains(HasSubstr("is 53.9 m across here; units = \"mm\" makes it 0.0539 m")));
  const Scene scaled = sceneWith("source = \"box.stl\"\nunits = \"m\"\nscale = 1000\n");
  EXPECT_THAT(scaled.notices, testing::Contains(HasSubstr("a scale of 0.0037 makes it 0.2 m")));
  const Scene inches = sceneWith("source = \"box.stl\"\nunits = \"in\"\nscale = 10\n");
  EXPECT_THAT(inches.notices, testing::Contains(HasSubstr("a scale of 0.15 makes it 0.2 m")));
}

}  // namespace
}  // namespace pleinair::scene
