// The form of surfaces, as painters see it: patches, limbs, and the directions of least curvature.
#include "pipeline/scene/models/surface_form.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/builtin/builtin_box.h"
#include "pipeline/scene/builtin/builtin_gear.h"
#include "pipeline/scene/builtin/shapes.h"

namespace pleinair::scene {
namespace {

std::size_t patchesOf(const Mesh& mesh) {
  std::set<std::uint32_t> patches;
  for (const TriangleForm& each : formsOf(mesh)) patches.insert(each.patch);
  return patches.size();
}

glm::vec3 middleOf(const Mesh& mesh, std::size_t triangle) {
  glm::vec3 sum(0.0F);
  for (const std::uint32_t corner : mesh.triangles[triangle]) sum += mesh.vertices[corner].position;
  return sum / 3.0F;
}

/// The outside of a ring about z.
Mesh tube(double radius, double height) {
  const std::array<glm::dvec2, 4> section{
      {{0.5 * radius, 0.0}, {radius, 0.0}, {radius, height}, {0.5 * radius, height}}};
  return turned(section, true, 48);
}

TEST(SurfaceForm, ATubesDirectionIsItsAxis) {
  const Mesh mesh = tube(0.1, 0.3);
  const std::vector<TriangleForm> forms = formsOf(mesh);
  int onSide = 0;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const glm::vec3 at = middleOf(mesh, i);
    const float away = std::hypot(at.x, at.y);
    if (away < 0.099F) continue;  // the inside and the ends
    ++onSide;
    EXPECT_GT(glm::length(forms[i].along), 0.95F);
    EXPECT_GT(std::abs(glm::normalize(forms[i].along).z), 0.999F);
  }
  EXPECT_GT(onSide, 40);
}

TEST(SurfaceForm, ASphereAndABoxHaveNoDirection) {
  for (const Mesh& mesh : {sphere(0.1, 48, 24), boxMesh({0.1, 0.2, 0.3})}) {
    const std::vector<TriangleForm> forms = formsOf(mesh);
    std::vector<float> clarity;
    for (const TriangleForm& each : forms) clarity.push_back(glm::length(each.along));
    std::ranges::sort(clarity);
    EXPECT_LT(clarity[clarity.size() / 2], 0.05F);
    EXPECT_LT(clarity[clarity.size() * 9 / 10], 0.3F);  // beside a sphere's poles
  }
}

/// Wherever the mesh is and however large.
TEST(SurfaceForm, GoesWithTheMesh) {
  const Mesh mesh = tube(0.1, 0.3);
  glm::dmat4 place = glm::translate(glm::dmat4(1.0), {3.0, -2.0, 1.0});
  place = glm::rotate(place, 1.1, glm::normalize(glm::dvec3(1.0, 2.0, 0.5)));
  place = glm::scale(place, glm::dvec3(20.0));
  Mesh moved;
  append(moved, mesh, place);
  const std::vector<TriangleForm> here = formsOf(mesh);
  const std::vector<TriangleForm> there = formsOf(moved);
  ASSERT_EQ(here.size(), there.size());
  int compared = 0;
  for (std::size_t i = 0; i < here.size(); ++i) {
    EXPECT_EQ(here[i].patch, there[i].patch);
    EXPECT_NEAR(glm::length(here[i].along), glm::length(there[i].along), 0.02F);
    if (glm::length(here[i].along) < 0.5F) continue;
    const glm::vec3 turned = glm::normalize(glm::vec3(place * glm::dvec4(here[i].along, 0.0)));
    EXPECT_GT(std::abs(glm::dot(turned, glm::normalize(there[i].along))), 0.999F);
    ++compared;
  }
  EXPECT_GT(compared, 40);
}

TEST(SurfaceForm, PatchesEndAtCreases) {
  EXPECT_EQ(patchesOf(boxMesh({0.1, 0.2, 0.3})), 6U);
  EXPECT_EQ(patchesOf(sphere(0.1, 24, 12)), 1U);
  EXPECT_EQ(patchesOf(tube(0.1, 0.3)), 4U) << "outside, inside and both ends";
}

/// The flanks of a gear's teeth are too narrow to be painted one by one.
TEST(SurfaceForm, SmallPatchesJoinTheirNeighbours) {
  GearParameters gear;
  gear.form.teeth = 40;
  const std::size_t patches = patchesOf(gearMesh(gear));
  EXPECT_LE(patches, 16U);
  EXPECT_GE(patches, 3U) << "both faces and the rim";
}

/// A skeleton with a spine, a neck, two arms with three fingers each and two legs.
struct Person {
  Rig rig;
  Skin skin;

  std::size_t add(std::optional<std::size_t> parent, double length) {
    RigNode node{.parent = parent};
    node.rest.translation = {0.0, length, 0.0};
    rig.nodes.push_back(node);
    skin.joints.push_back(rig.nodes.size() - 1);
    return rig.nodes.size() - 1;
  }
  std::size_t chain(std::size_t from, std::size_t count, double length) {
    for (std::size_t i = 0; i < count; ++i) from = add(from, length);
    return from;
  }
};

TEST(SurfaceForm, LimbsLeaveTheTrunk) {
  Person person;
  const std::size_t hip = person.add(std::nullopt, 0.0);
  const std::size_t foot = person.chain(hip, 3, 0.4);
  const std::size_t otherFoot = person.chain(hip, 3, 0.4);
  const std::size_t chest = person.chain(hip, 3, 0.2);
  const std::size_t head = person.chain(chest, 1, 0.1);
  std::vector<std::size_t> hands;
  std::vector<std::size_t> fingers;
  for (int side = 0; side < 2; ++side) {
    const std::size_t hand = person.chain(chest, 3, 0.3);
    hands.push_back(hand);
    for (int i = 0; i < 3; ++i) fingers.push_back(person.chain(hand, 2, 0.04));
  }
  const std::vector<std::size_t> limbs = limbsOf(person.rig, person.skin);
  EXPECT_EQ(limbs[hip], 0U);
  EXPECT_EQ(limbs[chest], 0U);
  EXPECT_EQ(limbs[head], 0U) << "a short one goes with the trunk";
  const std::set<std::size_t> ends{limbs[foot], limbs[otherFoot], limbs[hands[0]], limbs[hands[1]]};
  EXPECT_EQ(ends.size(), 4U);
  EXPECT_FALSE(ends.contains(0U));
  for (std::size_t i = 0; i < fingers.size(); ++i) {
    EXPECT_EQ(limbs[fingers[i]], limbs[hands[i / 3]]) << "fingers go with their hand";
  }
}

/// An arm and a trunk that are one smooth mesh are two patches.
TEST(SurfaceForm, PatchesEndAtLimbs) {
  Mesh mesh = tube(0.1, 0.4);
  mesh = withShortEdges(mesh, 0.05F);
  for (const MeshVertex& vertex : mesh.vertices) {
    JointWeights weights;
    weights.joints[0] = vertex.position.z > 0.2F ? 1 : 0;
    mesh.joints.push_back(weights);
  }
  const std::vector<std::size_t> limbs{0, 1};
  std::set<std::uint32_t> below;
  std::set<std::uint32_t> above;
  int atJoint = 0;
  const std::vector<TriangleForm> forms = formsOf(mesh, limbs);
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const float z = middleOf(mesh, i).z;
    if (z < 0.14F) below.insert(forms[i].patch);
    if (z > 0.26F) above.insert(forms[i].patch);
    // The joint is where they meet, on the tube's sides; a crease is none.
    const bool isAway = z < 0.14F || z > 0.26F;
    EXPECT_FALSE(isAway && forms[i].isAtJoint);
    atJoint += forms[i].isAtJoint ? 1 : 0;
    EXPECT_TRUE(!isAway || forms[i].isOnLimb == (z > 0.26F));
  }
  EXPECT_FALSE(below.empty());
  EXPECT_FALSE(above.empty());
  EXPECT_GT(atJoint, 40);
  for (const std::uint32_t patch : above) EXPECT_FALSE(below.contains(patch));
}

/// Degenerate triangles and empty meshes have forms too, without directions.
TEST(SurfaceForm, DegenerateMeshesAreFinite) {
  EXPECT_TRUE(formsOf(Mesh{}).empty());
  Mesh mesh = boxMesh({0.1, 0.2, 0.3});
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({2, 2, 2});
  const std::vector<TriangleForm> forms = formsOf(mesh);
  ASSERT_EQ(forms.size(), mesh.triangles.size());
  for (const TriangleForm& each : forms) {
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(std::isfinite(each.along[i]));
  }
}

}  // namespace
}  // namespace pleinair::scene
