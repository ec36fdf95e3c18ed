#include "hal/outputs/window/key_name.h"

#include <gtest/gtest.h>

namespace pleinair::hal::window {
namespace {

std::string nameOf(SDL_Keycode code, int modifiers = KMOD_NONE) {
  return keyName({.scancode = SDL_GetScancodeFromKey(code),
                  .sym = code,
                  .mod = static_cast<Uint16>(modifiers),
                  .unused = 0});
}

TEST(KeyName, IsNeutralAndInLowerCase) {
  EXPECT_EQ(nameOf(SDLK_f), "f");
  EXPECT_EQ(nameOf(SDLK_f, KMOD_LSHIFT), "f");
  EXPECT_EQ(nameOf(SDLK_TAB), "tab");
  EXPECT_EQ(nameOf(SDLK_TAB, KMOD_RSHIFT), "tab");
  EXPECT_EQ(nameOf(SDLK_LEFT), "left");
  EXPECT_EQ(nameOf(SDLK_PAGEDOWN), "pagedown");
  EXPECT_EQ(nameOf(SDLK_BACKSPACE), "backspace");
  EXPECT_EQ(nameOf(SDLK_ESCAPE), "escape");
  EXPECT_EQ(nameOf(SDLK_SPACE), "space");
  EXPECT_EQ(nameOf(SDLK_F1), "f1");
  EXPECT_EQ(nameOf(SDLK_7), "7");
}

TEST(KeyName, KnowsTheQuestionMark) {
  EXPECT_EQ(nameOf(SDLK_SLASH, KMOD_LSHIFT), "?");
  EXPECT_EQ(nameOf(SDLK_QUESTION), "?");
  EXPECT_EQ(nameOf(SDLK_SLASH), "/");
}

TEST(KeyName, LeavesTheDesktopsKeysAlone) {
  for (const int modifier : {KMOD_LCTRL, KMOD_RCTRL, KMOD_LALT, KMOD_LGUI}) {
    EXPECT_EQ(nameOf(SDLK_q, modifier), "");
  }
  EXPECT_EQ(nameOf(SDLK_q, KMOD_NUM | KMOD_CAPS), "q") << "locks are no modifiers";
  EXPECT_EQ(nameOf(SDLK_UNKNOWN), "");
}

}  // namespace
}  // namespace pleinair::hal::window
