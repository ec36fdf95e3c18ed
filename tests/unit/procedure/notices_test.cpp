#include "pipeline/procedure/notices.h"

#include <algorithm>
#include <array>
#include <string>

#include <gtest/gtest.h>

#include "pipeline/procedure/words.h"

namespace pleinair::procedure {
namespace {

/// All texts of a language, the name of the language first.
std::span<const std::string_view> textsOf(const Notices& notices) {
  static_assert(sizeof(Notices) % sizeof(std::string_view) == 0);
  return {&notices.language, sizeof(Notices) / sizeof(std::string_view)};
}

std::ptrdiff_t placesIn(std::string_view text) {
  std::ptrdiff_t count = 0;
  for (std::size_t at = text.find("{}"); at != std::string_view::npos;
       at = text.find("{}", at + 2)) {
    ++count;
  }
  return count;
}

TEST(Notices, EveryLanguageHasAllWithTheSamePlacesForValues) {
  const auto english = textsOf(allNotices().front());
  EXPECT_EQ(english.front(), "en");
  for (const Notices& each : allNotices()) {
    const auto texts = textsOf(each);
    for (std::size_t i = 0; i < texts.size(); ++i) {
      EXPECT_FALSE(texts[i].empty()) << each.language << ", beside: " << english[i];
      EXPECT_EQ(placesIn(texts[i]), placesIn(english[i])) << texts[i];
    }
  }
}

TEST(Notices, AreInTheLanguageOrInEnglish) {
  EXPECT_EQ(noticesIn("de-AT").language, "de");
  EXPECT_EQ(noticesIn("ja").language, "en");
  EXPECT_EQ(filled(noticesIn("de").nowWorks, "K. Öz"), "jetzt arbeitet: K. Öz");
}

TEST(Words, DecimalsAreTheLanguages) {
  EXPECT_EQ(withDecimals("2.5 ± 0.3 Nm", "en"), "2.5 ± 0.3 Nm");
  EXPECT_EQ(withDecimals("2.5 ± 0.3 Nm", "de-CH"), "2,5 ± 0,3 Nm");
  EXPECT_EQ(withDecimals("0.06 … 0.2 mm.", "pl"), "0,06 … 0,2 mm.");
  EXPECT_EQ(withDecimals("2.5 Nm", "ja"), "2.5 Nm") << "as the program's words beside it";
}

}  // namespace
}  // namespace pleinair::procedure
