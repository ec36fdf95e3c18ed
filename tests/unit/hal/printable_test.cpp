#include "hal/printable.h"

#include <gtest/gtest.h>

namespace pleinair::hal {
namespace {

TEST(Printable, NamesHaveNoControlCharacters) {
  EXPECT_EQ(printable("HD Webcam"), "HD Webcam");
  EXPECT_EQ(printable("Kamera für Tübingen"), "Kamera für Tübingen");
  EXPECT_EQ(printable("a\x1b[2Jb\n\x7f"), "a?[2Jb??");
  EXPECT_EQ(printable(""), "");
}

}  // namespace
}  // namespace pleinair::hal
