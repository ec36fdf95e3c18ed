#include "firmware_app/repair_station/command_cards.h"

#include <algorithm>
#include <utility>

namespace pleinair::app {

CommandCards::CommandCards(std::map<int, procedure::StepCommand> cards)
    : commands_(std::move(cards)) {
  for (const auto& [id, command] : commands_) cards_[id] = {};
}

/// Every card may be in view already, and counts only after it was away.
void CommandCards::restart() {
  for (auto& [id, card] : cards_) card = {.since = {}, .last = frame_, .isSpent = true};
}

std::optional<procedure::StepCommand> CommandCards::see(std::span<const ShownTag> tags,
                                                        hal::TimePoint captured) {
  const bool isContinued = frame_ && captured >= *frame_ && captured - *frame_ <= kAway;
  frame_ = captured;
  if (!isContinued) restart();
  std::optional<int> inView;
  bool areMany = false;
  for (auto& [id, card] : cards_) {
    const auto tag = std::ranges::find(tags, id, &ShownTag::id);
    if (tag != tags.end() && tag->edgeShare >= kMinEdgeShare) card.last = captured;
    const bool isHere = card.last && captured - *card.last <= kGap;
    if (!isHere) card.since.reset();
    if (card.last && captured - *card.last >= kAway) card.isSpent = false;
    if (!isHere) continue;
    areMany = areMany || inView;
    inView = id;
  }
  if (!inView || areMany) {
    for (auto& [id, card] : cards_) card.since.reset();
    return std::nullopt;
  }
  Card& card = cards_.at(*inView);
  if (!card.since) card.since = captured;
  // Only a frame that shows the card fires it.
  if (card.isSpent || card.last != captured || captured - *card.since < kShown) return std::nullopt;
  card.isSpent = true;
  return commands_.at(*inView);
}

}  // namespace pleinair::app
