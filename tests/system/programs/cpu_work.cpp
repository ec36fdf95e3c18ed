// A fixed amount of a processor's work, of the kinds that programs do: text, trees, hashes,
// allocations and numbers. How long it takes in a guest, over how long it takes on the host, is the
// guest's slowness ("patience").
//
// Prints a sum over its results, which is the same everywhere.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

namespace {

class Numbers {
 public:
  std::uint32_t next() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::uint32_t>(state_ >> 33);
  }

 private:
  std::uint64_t state_ = 1;
};

std::uint64_t ofText(Numbers& numbers) {
  std::vector<std::string> words;
  for (int i = 0; i < 40'000; ++i)
    words.push_back(std::to_string(numbers.next()) + "/" + std::to_string(i));
  std::ranges::sort(words);
  std::map<std::string, std::size_t> tree;
  std::unordered_map<std::string, std::size_t> table;
  for (const std::string& word : words) {
    tree[word.substr(0, 4)] += word.size();
    table[word] = word.size();
  }
  std::uint64_t sum = tree.size();
  for (const std::string& word : words) sum = sum * 31 + table.at(word);
  return sum;
}

std::uint64_t ofNumbers(Numbers& numbers) {
  std::vector<float> field(320 * 240);
  for (float& each : field) each = static_cast<float>(numbers.next() & 0xFF);
  for (int pass = 0; pass < 8; ++pass) {
    for (std::size_t i = 1; i + 1 < field.size(); ++i) {
      field[i] = 0.25F * field[i - 1] + 0.5F * field[i] + 0.25F * field[i + 1];
    }
  }
  float sum = 0;
  for (const float each : field) sum += std::sqrt(each);
  return static_cast<std::uint64_t>(sum / 1000);
}

}  // namespace

int main() {
  Numbers numbers;
  const std::uint64_t text = ofText(numbers);
  std::printf("%llu\n", static_cast<unsigned long long>(text + ofNumbers(numbers)));
}
