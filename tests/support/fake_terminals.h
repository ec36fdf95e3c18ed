#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "hal/console/virtual_terminal.h"

namespace pleinair::support {

/// Virtual terminals as the kernel switches them: another comes to the front once ours allows it.
class FakeTerminals final : public hal::Terminals {
 public:
  hal::Result<int> take() override {
    if (refusal) return tl::unexpected(*refusal);
    isTaken = true;
    return own;
  }
  void release() override { isTaken = false; }
  int front() override { return inFront; }
  void bringToFront(int number) override {
    wanted = number;
    if (inFront == own && isTaken && number != own) {
      requests.push_back(Request::kLeave);
    } else if (inFront != number) {
      inFront = number;
      if (number == own) requests.push_back(Request::kReturn);
    }
  }
  Request takeRequest() override {
    if (requests.empty()) return Request::kNone;
    const Request request = requests.front();
    requests.pop_front();
    return request;
  }
  void allowLeave() override {
    ++allowed;
    inFront = wanted;
  }
  void acknowledgeReturn() override { ++acknowledged; }

  int own = 1;
  int inFront = 1;
  int wanted = 1;
  bool isTaken = false;
  std::optional<hal::Error> refusal;
  std::deque<Request> requests;
  int allowed = 0;
  int acknowledged = 0;
};

}  // namespace pleinair::support
