#include "pipeline/runtime/outcome.h"

namespace pleinair::runtime {
namespace {

struct Words {
  std::string_view name;
  std::string_view text;
};

// In the order of Outcome.
constexpr std::array<Words, kOutcomes> kWords{{
    {"shown", "shown"},
    {"shown_off_schedule", "shown off schedule"},
    {"late", "late"},
    {"superseded", "superseded by a newer one"},
    {"output_busy", "while an output was busy"},
    {"no_surface", "without a free surface"},
    {"suspended", "while another console was in front"},
    {"blanked", "while the display was off"},
    {"output_failed", "by a failed output"},
    {"replaced", "replaced by a newer one"},
    {"paused", "while paused"},
    {"starting", "while starting"},
    {"stopped", "in flight at the end"},
    {"not_painted", "refused by the painter"},
    {"context_lost", "with a lost GPU"},
    {"corrupt", "corrupt"},
    {"incomplete", "incomplete"},
    {"mistimed", "with a wrong time"},
    {"buffer_underrun", "by a buffer underrun"},
    {"stalled", "while the camera stalled"},
    {"dropped_by_driver", "by the driver"},
}};

const Words& wordsOf(Outcome outcome) {
  return kWords.at(static_cast<std::size_t>(outcome));
}

}  // namespace

std::string_view nameOf(Outcome outcome) {
  return wordsOf(outcome).name;
}

std::string_view describe(Outcome outcome) {
  return wordsOf(outcome).text;
}

std::array<Outcome, kOutcomes> allOutcomes() {
  std::array<Outcome, kOutcomes> outcomes{};
  for (std::size_t i = 0; i < kOutcomes; ++i) outcomes.at(i) = static_cast<Outcome>(i);
  return outcomes;
}

}  // namespace pleinair::runtime
