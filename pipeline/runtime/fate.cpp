#include "pipeline/runtime/fate.h"

namespace pleinair::runtime {
namespace {

struct Words {
  std::string_view name;
  std::string_view text;
};

// In the order of Fate.
constexpr std::array<Words, kFates> kWords{{
    {"shown", "shown"},
    {"shown_untimely", "shown untimely"},
    {"late", "late"},
    {"overtaken", "overtaken by a newer one"},
    {"output_busy", "while an output was busy"},
    {"output_failed", "by a failed output"},
    {"replaced", "replaced by a newer one"},
    {"paused", "while paused"},
    {"starting", "while starting"},
    {"stopped", "unfinished at the end"},
    {"not_painted", "refused by the painter"},
    {"context_lost", "with a lost GPU"},
    {"corrupt", "corrupt"},
    {"incomplete", "incomplete"},
    {"mistimed", "with a wrong time"},
    {"starved", "for want of a buffer"},
    {"stalled", "while the camera stalled"},
    {"left_out", "left out by the camera"},
}};

const Words& wordsOf(Fate fate) {
  return kWords.at(static_cast<std::size_t>(fate));
}

}  // namespace

std::string_view nameOf(Fate fate) {
  return wordsOf(fate).name;
}

std::string_view describe(Fate fate) {
  return wordsOf(fate).text;
}

std::array<Fate, kFates> allFates() {
  std::array<Fate, kFates> fates{};
  for (std::size_t i = 0; i < kFates; ++i) fates.at(i) = static_cast<Fate>(i);
  return fates;
}

}  // namespace pleinair::runtime
