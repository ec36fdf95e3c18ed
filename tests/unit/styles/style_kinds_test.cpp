// The descriptors of all styles. Needs no GPU.
#include <array>
#include <set>
#include <string>

#include <gmock/gmock.h>

#include "config/config_error.h"
#include "pipeline/styles/registry.h"

namespace pleinair::styles {
namespace {

TEST(StyleKinds, AreDescribedInFull) {
  std::set<std::string_view> names;
  for (const StyleKind* kind : styleKinds()) {
    SCOPED_TRACE(kind->name);
    EXPECT_TRUE(names.insert(kind->name).second);
    EXPECT_EQ(&styleKind(kind->name), kind);
    EXPECT_NE(kind->help, "");
    EXPECT_NE(kind->make, nullptr);
    EXPECT_TRUE(kind->check == nullptr || kind->check(kind->defaults));
    std::set<std::string_view> views;
    for (const DebugViewInfo& view : kind->views) {
      EXPECT_TRUE(views.insert(view.name).second) << view.name;
      EXPECT_EQ(&kind->views[viewIndex(kind->views, view.name)], &view);
      EXPECT_NE(view.help, "");
    }
    EXPECT_FALSE(kind->coherence.holdsAnchors && kind->coherence.empty());
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"watercolor", "painterly", "hatching", "none"}));
}

TEST(StyleKinds, LooksGiveValuesOfTheStylesListAndUnknownOnesAreRefused) {
  for (const StyleKind* kind : styleKinds()) {
    for (const Look& look : kind->looks) {
      SCOPED_TRACE(look.name);
      const config::ParameterValues values = kind->parametersOf(look.name);
      EXPECT_EQ(&values.list(), &kind->defaults.list());
      EXPECT_EQ(values == kind->defaults, &look == &kind->looks.front());
    }
  }
  try {
    styleKind("watercolor").parametersOf("gouache");
    FAIL() << "has it";
  } catch (const config::ConfigError& error) {
    EXPECT_EQ(error.found(), "gouache");
    EXPECT_THAT(error.allowed(), testing::HasSubstr("line_and_wash"));
  }
}

TEST(DebugViews, GiveShadersTheirOwnNumbers) {
  constexpr std::array<DebugViewInfo, 2> kViews{{{"cells", "c"}, {"wet_edges", "w"}}};
  const gpu::ShaderDefines defines = viewDefines(kViews);
  ASSERT_EQ(defines.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(defines[i].name, i == 0 ? "VIEW_CELLS" : "VIEW_WET_EDGES");
    EXPECT_EQ(defines[i].value, std::to_string(viewIndex(kViews, kViews.at(i).name)));
  }
}

}  // namespace
}  // namespace pleinair::styles
