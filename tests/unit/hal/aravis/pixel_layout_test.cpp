#include "hal/cameras/aravis/pixel_layout.h"

#include <set>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pleinair::hal::aravis {
namespace {

TEST(PixelLayouts, AreDistinctAndFindable) {
  std::set<std::uint32_t> codes;
  std::set<std::string_view> names;
  for (const PixelLayout& each : pixelLayouts()) {
    EXPECT_TRUE(codes.insert(each.pfnc).second) << each.name;
    EXPECT_TRUE(names.insert(each.name).second) << each.name;
    EXPECT_EQ(findLayout(each.pfnc), &each);
  }
  EXPECT_EQ(findLayout(0x01100007), nullptr) << "Mono16";
  EXPECT_EQ(layoutName(0x01100007), "0x01100007");
}

TEST(PixelLayouts, HaveTheBytesThatTheirCodesSay) {
  EXPECT_EQ(findLayout(0x01080001)->bytesOf(7), 7u);
  EXPECT_EQ(findLayout(0x02180014)->bytesOf(7), 21u);
  EXPECT_EQ(findLayout(0x010C0047)->bytesOf(2), 3u);
  EXPECT_EQ(findLayout(0x010C0047)->bytesOf(7), 11u) << "84 bits";
}

TEST(ChooseLayout, PrefersColourInFewBits) {
  const auto chosen = [](const std::vector<std::uint32_t>& offered, std::string_view name = "auto",
                         std::optional<PixelFormat> format = {}) {
    const auto layout = chooseLayout(offered, name, format);
    return layout ? std::string((*layout)->name) : layout.error().message();
  };
  EXPECT_EQ(chosen({0x01080001, 0x02180014, 0x0108000B}), "BayerBG8");
  EXPECT_EQ(chosen({0x01080001, 0x02180014, 0x010C0059}), "BayerRG12p");
  EXPECT_EQ(chosen({0x01080001, 0x02180014}), "RGB8");
  EXPECT_EQ(chosen({0x010C0047, 0x01080001}), "Mono8");
  EXPECT_EQ(chosen({0x01080001, 0x0108000B}, "auto", PixelFormat::kGrey8), "Mono8");
  EXPECT_EQ(chosen({0x01080001, 0x0108000B}, "auto", PixelFormat::kI420), "BayerBG8");
  EXPECT_EQ(chosen({0x01080001, 0x010C0047}, "Mono12p"), "Mono12p");
  EXPECT_THAT(chosen({0x01080001}, "RGB8"), testing::HasSubstr("has no pixel format RGB8"));
  EXPECT_THAT(chosen({0x01080001, 0x01100007}, "RGB8"),
              testing::HasSubstr("auto, or of Mono8, 0x01100007"));
  EXPECT_THAT(chosen({0x01100007}), testing::HasSubstr("it offers 0x01100007"));
  EXPECT_THAT(chosen({}), testing::HasSubstr("it offers none"));
}

}  // namespace
}  // namespace pleinair::hal::aravis
