// Plays files and a fixed number of random changes of them: mutate COUNT FOLDER... ; the same every time.
// What does not come back is kept in the folder for temporary files.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "tests/fuzz/target.h"

namespace {

namespace fs = std::filesystem;

std::vector<std::string> read_corpus(int count, char** folders) {
  std::vector<fs::path> files;
  for (int i = 0; i < count; ++i)
    for (const auto& entry : fs::directory_iterator(folders[i]))
      if (entry.is_regular_file() && entry.path().extension() != ".md") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> texts;
  for (const fs::path& file : files) {
    std::ifstream stream(file, std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return texts;
}

/// One small change: a byte, a piece cut out, doubled or taken from another text, a number made extreme.
void change(std::string& text, const std::string& other, std::mt19937& random) {
  const auto below = [&random](std::size_t end) { return end == 0 ? 0 : random() % end; };
  const std::size_t place = below(text.size() + 1),
                    length = below(std::min<std::size_t>(40, text.size() - place) + 1);
  constexpr const char* kTokens[] = {"nan",
                                     "-inf",
                                     "1e999",
                                     "-1",
                                     "0",
                                     "[",
                                     "]",
                                     "{",
                                     "}",
                                     "\"",
                                     "\n",
                                     "=",
                                     ",",
                                     "''",
                                     "[[",
                                     "]]",
                                     "\xEF\xBB\xBF",
                                     "\xC7\x97",
                                     "1e-320",
                                     "99999999999999999999"};
  switch (below(6)) {
    case 0:
      if (place < text.size()) text[place] = static_cast<char>(random());
      return;
    case 1:
      text.erase(place, length);
      return;
    case 2:
      text.insert(place, text.substr(place, length));
      return;
    case 3: {
      const std::size_t from = below(other.size());
      text.insert(place, other.substr(from, below(60)));
      return;
    }
    case 4: {  // the number or word here
      const std::size_t end = std::min(text.find_first_of(" ,]\n", place), text.size());
      text.replace(place, end - place, kTokens[below(std::size(kTokens))]);
      return;
    }
    default:
      text.insert(place, kTokens[below(std::size(kTokens))]);
  }
}

constexpr unsigned kMostSeconds = 20;  // for one text

std::string g_text, g_file;  // what is being read, and where it is kept if that does not come back

extern "C" void keep_text(int signal) {
  const int file = open(g_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file >= 0 && write(file, g_text.data(), g_text.size()) >= 0)
    (void)write(2, g_file.data(), g_file.size());
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void run_one(std::string text) {
  g_text = std::move(text);
  alarm(kMostSeconds);
  (void)fuzz::run_one(g_text);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const std::vector<std::string> corpus = read_corpus(argc - 2, argv + 2);
  fuzz::require(!corpus.empty(), "there are files to begin with");
  g_file = (fs::temp_directory_path() / ("shatterbox_" + fs::path(argv[0]).filename().string() + "_last"))
               .string();
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGALRM}) std::signal(signal, keep_text);
  for (const std::string& text : corpus) run_one(text);
  std::mt19937 random(1);
  for (int i = 0; i < std::atoi(argv[1]); ++i) {
    std::string text = corpus[random() % corpus.size()];
    for (auto changes = 1 + random() % 4; changes > 0; --changes)
      change(text, corpus[random() % corpus.size()], random);
    run_one(std::move(text));
  }
  return 0;
}
