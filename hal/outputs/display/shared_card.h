#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/outputs/display/card.h"
#include "hal/outputs/display/route.h"

namespace pleinair::hal::display {

/// A card that all outputs of the process share, since only one descriptor of it can be the master:
/// who uses which of its parts, and whose flips are whose. Thread-safe.
class SharedCard {
 public:
  /// Opens the card, or gives the one that is open already. Errors: those of Cards::open().
  static Result<std::shared_ptr<SharedCard>> of(Cards& cards, const std::string& node);

  SharedCard(Cards& cards, std::unique_ptr<Card> card) : cards_(cards), card_(std::move(card)) {}

  Card& card() { return *card_; }

  /// Looks for the display that is asked for, chooses how to reach it, and claims those parts of
  /// the card. Errors: those of chooseConnector(), chooseMode() and routeTo().
  Result<DisplayRoute> claim(const DisplayRequest& request);
  void release(const DisplayRoute& route);

  /// Appends the flips of a CRTC since the last call. 0, or −errno.
  int takeFlips(ObjectId crtc, std::vector<FlipEvent>& flips);

  /// Becomes the master, unless it is. 0, or −errno: EACCES while another console is in front,
  /// EBUSY where another program is.
  int takeMaster();
  /// As Card::commit(); EACCES also while another console is in front.
  int commit(std::span<const Change> changes, Commit kind);

  /// The card is not there any more: of() opens it anew.
  void markRemoved();

 private:
  Cards& cards_;
  std::unique_ptr<Card> card_;
  std::mutex mutex_;  // guards the members below
  InUse inUse_;
  std::vector<ObjectId> connectors_;
  std::vector<FlipEvent> read_;
  std::map<ObjectId, std::vector<FlipEvent>> flips_;  ///< by CRTC, not taken yet
  /// What a claimed CRTC showed then; where it was off, what switches it off again.
  struct Before {
    std::optional<SavedCrtc> shown;
    std::vector<Change> off;
  };
  std::map<ObjectId, Before> before_;
  bool isRemoved_ = false;
  std::mutex commits_;  ///< held while one is made, and to yield between two

  friend void yieldCards();
  void yield();
};

/// Another console is about to come to the front: brings back what claimed CRTCs showed before, on
/// all open cards, and is their master no more. Nothing is committed until regainCards(). Any
/// thread; waits for a commit in progress.
void yieldCards();
/// Ours is in front again: displays take the master and set their modes anew.
void regainCards();
/// Whether another console is in front. Any thread.
bool areCardsYielded();
/// How often one came to the front. Any thread.
std::uint64_t timesYielded();

/// A display of a card, claimed for an output.
struct ClaimedDisplay {
  std::shared_ptr<SharedCard> card;
  DisplayRoute route;
};

/// Claims a display of the first card that has it. `name`: isDisplayName(); its connector takes the
/// place of the request's. Errors: those of SharedCard::of() and claim(), of the card whose error
/// tells most; kNotFound (there is no card).
Result<ClaimedDisplay> claimDisplay(Cards& cards, const std::string& name, DisplayRequest request);

}  // namespace pleinair::hal::display
