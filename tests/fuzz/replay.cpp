// Runs a fuzz target on every file of its corpus and on damaged copies of each, in builds without
// libFuzzer: replay FOLDER. The damage is seeded and thus the same in every run.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

constexpr std::size_t kCuts = 200;     // prefixes per file
constexpr std::size_t kDamaged = 300;  // modified copies per file

using Bytes = std::vector<std::uint8_t>;

Bytes read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void feed(const Bytes& bytes) { LLVMFuzzerTestOneInput(bytes.data(), bytes.size()); }

void feed_damaged(Bytes bytes, std::mt19937& random) {
  if (bytes.empty()) return;
  const std::size_t changes = 1 + random() % 4;
  for (std::size_t k = 0; k < changes; ++k) {
    const std::size_t at = random() % bytes.size();
    switch (random() % 3) {
      case 0:
        bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1U << random() % 8));
        break;
      case 1:
        bytes[at] = static_cast<std::uint8_t>(random());
        break;
      default:
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                     bytes[random() % bytes.size()]);
        break;
    }
  }
  feed(bytes);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: replay FOLDER\n", stderr);
    return 2;
  }
  std::size_t files = 0;
  std::mt19937 random(20240229);
  for (const auto& entry : std::filesystem::directory_iterator(arguments[1])) {
    const Bytes bytes = read(entry.path());
    feed(bytes);
    const std::size_t step = 1 + bytes.size() / kCuts;
    for (std::size_t end = 0; end < bytes.size(); end += step) {
      feed(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(end)));
    }
    for (std::size_t k = 0; k < kDamaged; ++k) feed_damaged(bytes, random);
    ++files;
  }
  if (files == 0) {
    std::fprintf(stderr, "no corpus in %s\n", arguments[1]);
    return 1;
  }
  std::printf("%zu files and their damaged copies\n", files);
  return 0;
}
