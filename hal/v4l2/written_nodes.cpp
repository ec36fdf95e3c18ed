#include "hal/v4l2/written_nodes.h"

#include <filesystem>
#include <mutex>
#include <set>
#include <system_error>

namespace pleinair::hal::v4l2 {
namespace {

struct Written {
  std::mutex mutex;
  std::multiset<std::string> nodes;
};

Written& written() {
  static Written all;
  return all;
}

std::string withoutLinks(const std::string& node) {
  std::error_code error;
  const std::filesystem::path path = std::filesystem::weakly_canonical(node, error);
  return error ? node : path.string();
}

}  // namespace

WrittenNode::WrittenNode(const std::string& node) : node_(withoutLinks(node)) {
  const std::scoped_lock lock(written().mutex);
  written().nodes.insert(node_);
}

WrittenNode::~WrittenNode() {
  const std::scoped_lock lock(written().mutex);
  written().nodes.erase(written().nodes.find(node_));
}

bool isWritten(const std::string& node) {
  const std::string path = withoutLinks(node);
  const std::scoped_lock lock(written().mutex);
  return written().nodes.contains(path);
}

}  // namespace pleinair::hal::v4l2
