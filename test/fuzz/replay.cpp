// Feeds a fuzz target with a kept corpus and with seeded mutations of it: what a build without libFuzzer can
// do in seconds. usage: replay_TARGET MUTATIONS [--keep FILE] FOLDER_OR_FILE...
// --keep FILE: every input is written there before it is tried, so that a crash leaves its own behind.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "target.h"

namespace {

namespace fs = std::filesystem;

std::vector<std::string> read_corpus(const std::vector<std::string>& places) {
  std::vector<fs::path> files;
  for (const std::string& place : places) {
    if (!fs::is_directory(place)) {
      files.emplace_back(place);
      continue;
    }
    for (const auto& entry : fs::directory_iterator(place))
      if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> corpus;
  for (const fs::path& file : files) {
    std::ifstream input(file, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(input), std::istreambuf_iterator<char>());
  }
  return corpus;
}

/// Bytes and numbers that parsers stumble over.
const std::vector<std::string>& dictionary() {
  using namespace std::string_literals;
  static const std::vector<std::string> words{
      "0",   "-1",  "1e308", "-1e308", "1e-320", "nan", ".inf", "4294967296", "18446744073709551616",
      "{",   "}",   "[",     "]",      "[[[[[[", "\"",  "'",    "\n",         ":",
      "- ",  "&a ", "*a",    "!",      "|\n",    "#",   "\0"s,  "\xff",       "\xf0\x9f\x92\xa7",
      "<g>", "</",  "z",     "A",      "e",      ",",   "null", "true",       "1 um"};
  return words;
}

/// A child of an input: some edits, each of a kind.
std::string mutated(std::string bytes, const std::vector<std::string>& corpus, std::mt19937_64& random) {
  const auto below = [&random](std::size_t n) { return n > 0 ? static_cast<std::size_t>(random() % n) : 0; };
  for (std::size_t edits = 1 + below(4); edits > 0; --edits) {
    const std::size_t at = below(bytes.size() + 1),
                      length = below(std::min<std::size_t>(64, bytes.size() - at) + 1);
    switch (below(7)) {
      case 0:
        if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 1:
        if (at < bytes.size()) bytes[at] = static_cast<char>(random());
        break;
      case 2:
        bytes.erase(at, length);
        break;
      case 3:
        bytes.insert(at, bytes.substr(at, length));
        break;
      case 4:
        bytes.replace(at, length, dictionary()[below(dictionary().size())]);
        break;
      case 5:
        bytes.insert(at, dictionary()[below(dictionary().size())]);
        break;
      default: {
        const std::string& other = corpus[below(corpus.size())];
        const std::size_t from = below(other.size() + 1);
        bytes.replace(at, length, other.substr(from, below(200)));
      }
    }
  }
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> places(argv + std::min(argc, 2), argv + argc);
  const long mutations = argc > 1 ? std::stol(argv[1]) : -1;
  std::string keep;
  if (places.size() > 1 && places[0] == "--keep") {
    keep = places[1];
    places.erase(places.begin(), places.begin() + 2);
  }
  const std::vector<std::string> corpus = read_corpus(places);
  if (mutations < 0 || corpus.empty()) {
    std::cerr << "usage: " << argv[0]
              << " MUTATIONS [--keep FILE] FOLDER_OR_FILE..., and there must be a file\n";
    return 2;
  }
  using Clock = std::chrono::steady_clock;
  double slowest = 0;
  std::size_t tried = 0;
  const auto attempt = [&](const std::string& input) {
    if (!keep.empty()) std::ofstream(keep, std::ios::binary | std::ios::trunc) << input;
    const auto start = Clock::now();
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
    slowest = std::max(slowest, std::chrono::duration<double>(Clock::now() - start).count());
    ++tried;
  };
  for (const std::string& input : corpus) attempt(input);
  std::mt19937_64 random(20261122);
  for (long k = 0; k < mutations; ++k)
    attempt(mutated(corpus[static_cast<std::size_t>(random() % corpus.size())], corpus, random));
  std::cout << tried << " inputs, " << corpus.size() << " of them kept; the slowest took " << slowest
            << " s\n";
  return 0;
}
