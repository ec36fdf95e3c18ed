#include "hal/outputs/display/shared_card.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <iterator>
#include <optional>
#include <utility>

#include "hal/outputs/display/display_errors.h"
#include "hal/outputs/display/modeset.h"

namespace pleinair::hal::display {
namespace {

/// The cards that are open, by where they come from and their nodes.
struct OpenCards {
  std::mutex mutex;
  std::map<std::pair<Cards*, std::string>, std::weak_ptr<SharedCard>> cards;
};

OpenCards& openCards() {
  static OpenCards cards;
  return cards;
}

std::atomic<bool> isYielded{false};
std::atomic<std::uint64_t> yields{0};

}  // namespace

Result<std::shared_ptr<SharedCard>> SharedCard::of(Cards& cards, const std::string& node) {
  OpenCards& open = openCards();
  const std::scoped_lock lock(open.mutex);
  std::weak_ptr<SharedCard>& known = open.cards[{&cards, node}];
  if (std::shared_ptr<SharedCard> shared = known.lock()) return shared;
  Result<std::unique_ptr<Card>> opened = cards.open(node);
  if (!opened) return tl::unexpected(opened.error());
  auto shared = std::make_shared<SharedCard>(cards, *std::move(opened));
  // The kernel makes the first program that opens a card its master.
  if (isYielded) shared->card().dropMaster();
  known = shared;
  return shared;
}

void SharedCard::markRemoved() {
  OpenCards& open = openCards();
  const std::scoped_lock lock(open.mutex, mutex_);
  if (!std::exchange(isRemoved_, true)) open.cards.erase({&cards_, card_->node()});
}

Result<DisplayRoute> SharedCard::claim(const DisplayRequest& request) {
  // Asking the displays takes up to some 100 ms, for which no other output's flips are to wait.
  const Result<CardState> state = card_->read(true);
  const std::scoped_lock lock(mutex_);
  if (!state) return tl::unexpected(state.error());
  const Result<Connector> connector = chooseConnector(*state, request.connector, connectors_);
  if (!connector) return tl::unexpected(connector.error());
  const Result<Mode> mode = chooseMode(*connector, request);
  if (!mode) return tl::unexpected(mode.error());
  Result<DisplayRoute> route = routeTo(*state, *connector, *mode, inUse_);
  if (!route) return route;
  inUse_.crtcs |= std::uint32_t{1} << route->crtcIndex;
  inUse_.planes |= std::uint64_t{1} << route->planeIndex;
  connectors_.push_back(route->connector.id);
  before_[route->crtc.id] = {card_->saveCrtc(route->crtc.id), switchOffChanges(*route)};
  flips_[route->crtc.id].clear();
  return route;
}

void SharedCard::release(const DisplayRoute& route) {
  const std::scoped_lock lock(mutex_);
  inUse_.crtcs &= ~(std::uint32_t{1} << route.crtcIndex);
  inUse_.planes &= ~(std::uint64_t{1} << route.planeIndex);
  std::erase(connectors_, route.connector.id);
  flips_.erase(route.crtc.id);
  before_.erase(route.crtc.id);
}

int SharedCard::takeMaster() {
  const std::scoped_lock lock(commits_);
  if (isYielded) return -EACCES;
  return card_->isMaster() ? 0 : card_->becomeMaster();
}

int SharedCard::commit(std::span<const Change> changes, Commit kind) {
  const std::scoped_lock lock(commits_);
  if (isYielded) return -EACCES;
  return card_->commit(changes, kind);
}

void SharedCard::yield() {
  const std::scoped_lock lock(mutex_, commits_);
  for (const auto& [crtc, before] : before_) {
    if (before.shown) {
      card_->restore(*before.shown);
    } else {
      card_->commit(before.off, Commit::kModeset);
    }
  }
  card_->dropMaster();
}

void yieldCards() {
  OpenCards& open = openCards();
  const std::scoped_lock lock(open.mutex);
  isYielded = true;
  ++yields;
  for (const auto& [place, card] : open.cards) {
    if (const std::shared_ptr<SharedCard> shared = card.lock()) shared->yield();
  }
}

void regainCards() {
  isYielded = false;
}

bool areCardsYielded() {
  return isYielded;
}

std::uint64_t timesYielded() {
  return yields;
}

int SharedCard::takeFlips(ObjectId crtc, std::vector<FlipEvent>& flips) {
  const std::scoped_lock lock(mutex_);
  read_.clear();
  const int failed = card_->takeFlips(read_);
  for (const FlipEvent& each : read_) {
    // Flips of an output that has gone are nobody's.
    if (const auto of = flips_.find(each.crtc); of != flips_.end()) of->second.push_back(each);
  }
  std::vector<FlipEvent>& own = flips_[crtc];
  std::ranges::copy(own, std::back_inserter(flips));
  own.clear();
  return failed;
}

Result<ClaimedDisplay> claimDisplay(Cards& cards, const std::string& name, DisplayRequest request) {
  const DisplayName parsed = parseDisplayName(name);
  request.connector = parsed.connector;
  std::optional<Error> problem;
  for (const std::string& node : cards.nodes()) {
    if (!parsed.isOn(node)) continue;
    const Result<std::shared_ptr<SharedCard>> card = SharedCard::of(cards, node);
    Result<DisplayRoute> route =
        card ? (*card)->claim(request) : Result<DisplayRoute>(tl::unexpected(card.error()));
    if (route) return ClaimedDisplay{*card, *std::move(route)};
    // A connector that another card lacks says less than one that is empty or taken.
    if (!problem || problem->kind == ErrorKind::kNotFound) problem = std::move(route.error());
  }
  return tl::unexpected(problem ? *std::move(problem) : noCard(name));
}

}  // namespace pleinair::hal::display
