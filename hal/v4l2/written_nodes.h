#pragma once

#include <string>

namespace pleinair::hal::v4l2 {

/// Notes that an output of this process writes to a node, as long as it lives. A loopback device
/// that is fed looks like a camera; one that shows the program its own picture is none. Any thread.
class WrittenNode {
 public:
  /// `node`: a path; links are followed.
  explicit WrittenNode(const std::string& node);
  ~WrittenNode();
  WrittenNode(const WrittenNode&) = delete;
  WrittenNode& operator=(const WrittenNode&) = delete;

 private:
  std::string node_;
};

/// Whether an output of this process writes to the node.
bool isWritten(const std::string& node);

}  // namespace pleinair::hal::v4l2
