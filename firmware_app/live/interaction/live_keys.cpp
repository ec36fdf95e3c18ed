#include "firmware_app/live/interaction/live_keys.h"

#include <utility>

#include <fmt/format.h>

namespace pleinair::app {

LiveKeys::LiveKeys(hal::KeyboardChoice choice, hal::KeyboardDevices& devices, LiveTuning& tuning,
                   const hal::Clock& clock)
    : keyboards_(std::move(choice), devices, clock), tuning_(tuning) {}

LiveKeys::Taken LiveKeys::take() {
  Taken taken;
  keys_.clear();
  keyboards_.takeKeys(keys_);
  keyboards_.takeProblems(taken.problems);
  taken.anyKey = !keys_.empty();
  for (const hal::KeyPressed& key : keys_) {
    const bool showedHelp = tuning_.showsHelp();
    const LiveTuning::Request request = tuning_.press(key);
    if (request == LiveTuning::Request::kUnknownKey) continue;
    taken.requests.tuned = true;
    if (request == LiveTuning::Request::kQuit) taken.requests.quit = true;
    if (request == LiveTuning::Request::kSnapshot) taken.requests.snapshot = true;
    if (request == LiveTuning::Request::kSaveLook) taken.requests.saveLook = true;
    if (request == LiveTuning::Request::kCommandLine) taken.requests.commandLine = true;
    if (tuning_.showsHelp() && !showedHelp) taken.state.push_back(tuning_.help());
  }
  if (taken.requests.tuned) {
    taken.state.push_back(fmt::format("{} · {}", tuning_.state(), tuning_.parameterLine()));
  }
  return taken;
}

}  // namespace pleinair::app
