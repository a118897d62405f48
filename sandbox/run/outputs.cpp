#include "sandbox/run/outputs.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "render/output/ending.h"

namespace shatterbox::sandbox::run {

namespace {

namespace fs = std::filesystem;

// What a file is called until it is whole, and what lies beside it meanwhile.
constexpr const char* kBeside[] = {"", ".part", ".next", ".plain", ".checkpoint", ".lock"};

/// The name in full, without links in its folder; and what it is a link to.
std::vector<fs::path> places_of(const std::string& path) {
  std::error_code code;
  fs::path whole = fs::absolute(path, code).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();  // a folder may end in a slash
  std::vector<fs::path> places{fs::weakly_canonical(whole.parent_path(), code) / whole.filename()};
  fs::path target = fs::weakly_canonical(whole, code);
  if (!code && target != places.front()) places.push_back(std::move(target));
  return places;
}

bool lies_in(const fs::path& inner, const fs::path& outer) {
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

bool is_one_of(const fs::path& place, const std::vector<fs::path>& places) {
  return std::find(places.begin(), places.end(), place) != places.end();
}

/// Whether the name is the pattern with digits in place of its *.
bool is_like(const std::string& name, const std::string& pattern) {
  const std::size_t star = pattern.find('*');
  if (star == std::string::npos) return name == pattern;
  const std::string tail = pattern.substr(star + 1);
  if (name.size() <= star + tail.size() || !name.starts_with(pattern.substr(0, star)) ||
      !name.ends_with(tail))
    return false;
  return std::all_of(name.begin() + static_cast<std::ptrdiff_t>(star),
                     name.end() - static_cast<std::ptrdiff_t>(tail.size()),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// The nearest folder above that is there.
fs::path ground_of(fs::path path) {
  std::error_code code;
  path = fs::absolute(path, code).lexically_normal();
  while (!fs::exists(path, code) && path.has_relative_path()) path = path.parent_path();
  return path;
}

std::string folder_fault(const std::string& folder) {
  std::error_code code;
  const fs::path ground = ground_of(folder);
  if (!fs::is_directory(ground, code))
    return fmt::format("folder {} cannot be made: {}", folder,
                       fs::exists(folder, code) ? "it is a file" : ground.string() + " is a file");
  if (access(ground.c_str(), W_OK | X_OK) == 0) return {};
  if (fs::is_directory(folder, code)) return fmt::format("folder {}: {}", folder, std::strerror(errno));
  return fmt::format("folder {} cannot be made: {}: {}", folder, ground.string(), std::strerror(errno));
}

}  // namespace

void Outputs::read_file(const std::string& option, const std::string& file) {
  if (!file.empty()) inputs_.push_back({option, file, {}, false, places_of(file)});
}

void Outputs::read_folder(const std::string& option, const std::string& folder, const std::string& ending) {
  if (!folder.empty()) inputs_.push_back({option, folder, ending, true, places_of(folder)});
}

void Outputs::write(const std::string& option, const std::string& path, Kind kind,
                    std::vector<std::string> names) {
  if (!path.empty()) outputs_.push_back({option, path, kind, std::move(names), places_of(path)});
}

void Outputs::write_file(const std::string& option, const std::string& file) {
  write(option, file, Kind::file, {});
}

void Outputs::write_folder(const std::string& option, const std::string& folder,
                           std::vector<std::string> names) {
  write(option, folder, Kind::folder, std::move(names));
}

void Outputs::replace_folder(const std::string& option, const std::string& folder) {
  write(option, folder, Kind::replaced, {});
}

bool Outputs::holds_name(const Output& folder, const fs::path& file) {
  if (!is_one_of(file.parent_path(), folder.places)) return false;
  std::string name = file.filename().string();
  if (name.ends_with(".part")) name.resize(name.size() - 5);
  return name == "checkpoint" || std::any_of(folder.names.begin(), folder.names.end(),
                                             [&](const std::string& like) { return is_like(name, like); });
}

bool Outputs::harms(const Output& output, const Input& input) {
  for (const fs::path& read : input.places) {
    for (const fs::path& written : output.places) {
      if (output.kind == Kind::replaced && lies_in(read, written)) return true;
      if (!input.is_folder) {
        if (output.kind == Kind::folder && holds_name(output, read)) return true;
        if (output.kind == Kind::file &&
            std::any_of(std::begin(kBeside), std::end(kBeside),
                        [&](const char* beside) { return written.string() + beside == read.string(); }))
          return true;
      } else if (lies_in(written, read)) {
        const bool is_read = input.ending.empty() || render::lower_case_ending(written) == input.ending;
        if (output.kind != Kind::file || is_read) return true;
      }
    }
  }
  return false;
}

bool Outputs::clash(const Output& a, const Output& b) {
  const fs::path &first = a.places.front(), &second = b.places.front();
  if (a.kind == Kind::folder && b.kind == Kind::folder)
    return std::find_first_of(a.places.begin(), a.places.end(), b.places.begin(), b.places.end()) !=
               a.places.end() &&
           std::find_first_of(a.names.begin(), a.names.end(), b.names.begin(), b.names.end()) !=
               a.names.end();
  if (a.kind == Kind::folder) return clash(b, a);
  if (b.kind == Kind::folder)  // a folder cannot be in a file
    return lies_in(second, first) || holds_name(b, first);
  for (const char* one : kBeside)
    for (const char* other : kBeside)
      if (first.string() + one == second.string() + other) return true;
  return false;
}

bool Outputs::will_be_there(const fs::path& folder) const {
  std::error_code code;
  if (fs::is_directory(folder, code)) return true;
  const fs::path place = places_of(folder.string()).front();
  return std::any_of(outputs_.begin(), outputs_.end(), [&place](const Output& output) {
    return output.kind == Kind::folder && lies_in(output.places.front(), place);
  });
}

std::string Outputs::fault(const Output& output) const {
  if (output.kind != Kind::file) return folder_fault(output.path);
  std::error_code code;
  const fs::path path(output.path);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::string why;
  if (fs::is_directory(path, code)) {
    why = "is a folder";
    // It is written beside itself and takes the name when it is whole: a device or a pipe would be gone.
  } else if (fs::exists(path, code) && !fs::is_regular_file(path, code)) {
    why = "is no plain file";
  } else if (!will_be_there(folder)) {
    why = fmt::format("there is no folder {}", folder.string());
  } else if (fs::exists(folder, code) && access(folder.c_str(), W_OK) != 0) {
    why = fmt::format("folder {}: {}", folder.string(), std::strerror(errno));
  } else if (fs::exists(path, code) && access(path.c_str(), W_OK) != 0) {
    why = std::strerror(errno);
  }
  return why.empty() ? why : fmt::format("{} cannot be written: {}", output.path, why);
}

std::string Outputs::harm_in_words(const Output& output, const Input& input) {
  if (output.path == input.path)
    return fmt::format("{} is what {} reads, and would be written over", input.path, input.option);
  if (input.is_folder)
    return fmt::format("{} would be written among what {} reads in {}", output.path, input.option,
                       input.path);
  return fmt::format("{} would be written over {}, which {} reads", output.path, input.path, input.option);
}

std::string Outputs::clash_in_words(const Output& output, const Output& other) {
  if (output.path == other.path) return fmt::format("{} is what {} writes too", output.path, other.option);
  return fmt::format("{} would be written over what {} writes, {}", output.path, other.option, other.path);
}

void Outputs::check(scene::Problems& problems) const {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const Output& output = outputs_[i];
    const scene::Place place{output.option, 0, 0};
    if (std::string sentence = fault(output); !sentence.empty())
      scene::book(problems, place, std::move(sentence));
    for (const Input& input : inputs_)
      if (harms(output, input))
        scene::book(problems, place, harm_in_words(output, input), "give it another name");
    for (std::size_t k = 0; k < i; ++k)
      if (clash(output, outputs_[k]))
        scene::book(problems, place, clash_in_words(output, outputs_[k]), "give each a name of its own");
  }
}

void Outputs::take(scene::Problems& problems) {
  std::vector<fs::path> taken;  // folders; one may be there for several options
  for (const Output& output : outputs_) {
    const scene::Place place{output.option, 0, 0};
    std::error_code code;
    if (output.kind == Kind::folder) fs::create_directories(output.path, code);
    if (output.kind == Kind::replaced) fs::create_directories(output.places.front().parent_path(), code);
    if (code) {
      scene::book(problems, place, fmt::format("folder {} cannot be made: {}", output.path, code.message()));
      continue;
    }
    if (is_one_of(output.places.front(), taken)) continue;
    taken.push_back(output.places.front());
    claims_.push_back(output.kind == Kind::folder ? Claim::on_folder(output.path)
                                                  : Claim::on_file(output.places.front().string()));
    if (claims_.back().is_refused())
      scene::book(problems, place, fmt::format("another run is writing {}", output.path),
                  "wait until it is over, or give this one another name");
  }
}

}  // namespace shatterbox::sandbox::run
