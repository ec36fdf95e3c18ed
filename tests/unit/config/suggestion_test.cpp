#include "config/suggestion.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace pleinair::config {
namespace {

const std::vector<std::string> kNames = {"cell_size", "edge", "paper_strength", "id"};

TEST(Suggestion, FindsSlips) {
  EXPECT_EQ(nearest("egde", kNames), "edge");            // swapped
  EXPECT_EQ(nearest("edg", kNames), "edge");             // missing
  EXPECT_EQ(nearest("Cell-Size", kNames), "cell_size");  // case and dash
  EXPECT_EQ(nearest("papr_strenght", kNames), "paper_strength");
}

TEST(Suggestion, KeepsSilentWhereNothingIsNear) {
  EXPECT_EQ(nearest("colour", kNames), std::nullopt);
  EXPECT_EQ(nearest("ix", kNames), std::nullopt);
  EXPECT_EQ(nearest("", kNames), std::nullopt);
  EXPECT_EQ(nearest(std::string(100'000, 'e'), kNames), std::nullopt);
  EXPECT_EQ(nearest("edge", {}), std::nullopt);
}

TEST(Suggestion, JudgesAFamilyByWhatFollowsItsName) {
  const std::vector<std::string> names = {"synthetic", "synthetic:roll", "synthetic:pan"};
  EXPECT_EQ(nearest("synthetic:nope", names), std::nullopt);
  EXPECT_EQ(nearest("synthetic:pann", names), "synthetic:pan");
  EXPECT_EQ(nearest("sinthetic:pan", names), "synthetic:pan");
}

TEST(Suggestion, TakesTheNearest) {
  const std::vector<std::string> names = {"seed_count", "seed_counts"};
  EXPECT_EQ(nearest("seed_counts", names), "seed_counts");
  EXPECT_EQ(unknownText("style", "seed_count_", names),
            "unknown style (did you mean \"seed_count\"?)");
  EXPECT_EQ(unknownText("style", "x", names), "unknown style");
  EXPECT_EQ(listText(names), "seed_count, seed_counts");
  EXPECT_EQ(listText({}), "none");
}

}  // namespace
}  // namespace pleinair::config
