#include "firmware_app/cli/text_table.h"

#include <gtest/gtest.h>

namespace pleinair::app {
namespace {

TEST(TextTable, AlignsAndGoesOnInItsColumn) {
  EXPECT_EQ(textTable({{"a", "one two three"}, {"long", "é é é é"}}, 18),
            "    a     one two\n"
            "          three\n"
            "    long  é é é é\n");
}

TEST(TextTable, LetsLongWordsStickOut) {
  EXPECT_EQ(textTable({{"a", "considerably so"}}, 9),
            "    a  considerably\n"
            "       so\n");
  EXPECT_EQ(textTable({{"a", ""}}), "    a  \n");
  EXPECT_EQ(textTable({}), "");
}

}  // namespace
}  // namespace pleinair::app
