// Limited palettes: which mixtures there are, and that strokes take them.
#include "pipeline/styles/painterly/palette.h"

#include <random>
#include <string>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/painterly/painterly_fixture.h"

namespace pleinair::styles {
namespace {

/// As distances are weighed.
double apart(const glm::vec3& a, const glm::vec3& b) {
  const glm::dvec3 d = glm::dvec3(a) - glm::dvec3(b);
  const double luma = 1.6 * glm::dot(d, glm::dvec3(0.299, 0.587, 0.114));
  const double blue = glm::dot(d, glm::dvec3(-0.169, -0.331, 0.5));
  const double red = glm::dot(d, glm::dvec3(0.5, -0.419, -0.081));
  return std::sqrt(luma * luma + blue * blue + red * red);
}

class Random {
 public:
  float part() { return std::uniform_real_distribution<float>(0.0F, 1.0F)(engine_); }
  glm::vec3 colour() { return {part(), part(), part()}; }
  /// Any mixture of the pigments.
  glm::vec3 mixture(const Pigments& pigments) {
    glm::vec3 sum(0.0F);
    float weights = 0.0F;
    for (const glm::vec3& each : pigments) {
      const float weight = -std::log(std::max(part(), 1e-6F));
      sum += weight * each;
      weights += weight;
    }
    return sum / weights;
  }

 private:
  std::mt19937 engine_{7};
};

TEST(Palette, IsAListOfColoursOrAName) {
  EXPECT_TRUE(isPalette("all"));
  EXPECT_TRUE(pigmentsOf("all").empty());
  EXPECT_EQ(pigmentsOf("zorn").size(), 4U);
  EXPECT_EQ(pigmentsOf("#ff0000 #00FF00"), (Pigments{{1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(pigmentsOf("  #000000   #ffffff ").size(), 2U);
  for (const char* text : {"", "blue", "#ff0000", "#ff00 #00ff00", "#ff000g #00ff00",
                           "ff0000 00ff00", "#ff0000,#00ff00", "#ff0000 #-0ff00"}) {
    EXPECT_FALSE(isPalette(text)) << text;
  }
  std::string nine = "#000000";
  for (int i = 0; i < 8; ++i) nine += " #000000";
  EXPECT_FALSE(isPalette(nine)) << nine;
}

TEST(Palette, MixesTheNearestThatItCan) {
  Random random;
  for (const char* name : {"zorn", "earth", "sepia", "#ff0000 #0000ff"}) {
    const Pigments pigments = pigmentsOf(name);
    for (int i = 0; i < 50; ++i) {
      const glm::vec3 own = random.mixture(pigments);
      EXPECT_LT(apart(mixedOf(pigments, own), own), 1e-5) << name << ": it is a mixture already";
      const glm::vec3 any = random.colour();
      const glm::vec3 mixed = mixedOf(pigments, any);
      EXPECT_LT(apart(mixedOf(pigments, mixed), mixed), 1e-5) << name << ": is not a mixture";
      const double least = apart(mixed, any);
      for (int j = 0; j < 200; ++j) {
        EXPECT_GE(apart(random.mixture(pigments), any), least - 1e-6) << name;
      }
    }
  }
}

/// Similar colours map to similar colours, so that a limited palette adds no flicker.
TEST(Palette, TakesNeighboursToNeighbours) {
  Random random;
  const Pigments pigments = pigmentsOf("zorn");
  for (int i = 0; i < 500; ++i) {
    const glm::vec3 a = random.colour();
    const glm::vec3 b = random.colour();
    EXPECT_LE(apart(mixedOf(pigments, a), mixedOf(pigments, b)), apart(a, b) + 1e-6);
  }
}

TEST_F(PainterlyTest, StrokesAreMixedOfThePalette) {
  Painterly style(library_);
  const auto chromaWith = [&](const char* palette) {
    restart();
    style.reset();
    style.setParameters(style.parameters()
                            .with("palette", palette)
                            .with("relief", "0")
                            .with("gloss", "0")
                            .with("canvas", "0")
                            .with("saturation", "1")
                            .with("warmth", "0"));
    const std::vector<std::uint8_t> painted = paint(style, next(testPicture(kSize, 5)));
    int most = 0;
    for (std::size_t i = 0; i < painted.size(); i += 4) {
      most = std::max(most, std::max(std::abs(int{painted[i]} - int{painted[i + 1]}),
                                     std::abs(int{painted[i + 1]} - int{painted[i + 2]})));
    }
    return most;
  };
  EXPECT_GT(chromaWith("all"), 40);
  // The ground is a mixture of a grey one, but for the wash's own ground colour.
  style.setParameters(style.parameters().with("wash", "1"));
  EXPECT_LE(chromaWith("#000000 #ffffff"), 3);
  style.setParameters(style.parameters().with("palette", "all"));
  EXPECT_GT(chromaWith("all"), 40) << "it can be given up again";
}

}  // namespace
}  // namespace pleinair::styles
