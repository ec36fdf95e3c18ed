#include "hal/console/virtual_terminal.h"

#include <utility>

namespace pleinair::hal {

Result<std::unique_ptr<VirtualTerminal>> VirtualTerminal::open(Terminals& terminals,
                                                               Switching switching) {
  const Result<int> number = terminals.take();
  if (!number) return tl::unexpected(number.error());
  return std::unique_ptr<VirtualTerminal>(
      new VirtualTerminal(terminals, std::move(switching), *number));
}

VirtualTerminal::VirtualTerminal(Terminals& terminals, Switching switching, int number)
    : terminals_(terminals), switching_(std::move(switching)), number_(number) {
  const int front = terminals_.front();
  if (front == 0 || front == number_) return;
  // Until it comes to the front, the displays are another console's.
  isInFront_ = false;
  switching_.leave();
  terminals_.bringToFront(number_);
}

VirtualTerminal::~VirtualTerminal() {
  if (!isInFront_) switching_.enter();
  terminals_.release();
}

bool VirtualTerminal::follow() {
  switch (terminals_.takeRequest()) {
    case Terminals::Request::kNone:
      return false;
    case Terminals::Request::kLeave:
      if (std::exchange(isInFront_, false)) switching_.leave();
      terminals_.allowLeave();
      return true;
    case Terminals::Request::kReturn:
      terminals_.acknowledgeReturn();
      if (!std::exchange(isInFront_, true)) switching_.enter();
      return true;
  }
  return false;
}

}  // namespace pleinair::hal
