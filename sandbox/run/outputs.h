// What a verb reads and writes, by the words of the command line that name it. Whether all of that can be is
// told before anything is done: no output takes the place of what is read, or of another output.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sandbox/run/claim.h"
#include "sandbox/scene/problem.h"

namespace shatterbox::sandbox::run {

class Outputs {
 public:
  // Empty names are none. `option` is the word that names the file or folder.

  void read_file(const std::string& option, const std::string& file);
  /// All in it, or all of an ending (".png"), in its subfolders too.
  void read_folder(const std::string& option, const std::string& folder, const std::string& ending = {});
  void write_file(const std::string& option, const std::string& file);
  /// `names` of the files in it, a * for a number: "frame_*.png".
  void write_folder(const std::string& option, const std::string& folder,
                    std::vector<std::string> names = {});
  /// A folder that gives way to a new one with all that is in it.
  void replace_folder(const std::string& option, const std::string& folder);

  /// What cannot be, or must not, goes to `problems`. Nothing is made.
  void check(scene::Problems& problems) const;
  /// Makes the folders, and keeps other processes from writing there while this lives; who is there already
  /// is a problem.
  void take(scene::Problems& problems);

 private:
  enum class Kind { file, folder, replaced };
  struct Input {
    std::string option, path, ending;
    bool is_folder = false;
    std::vector<std::filesystem::path> places;  // by its own name, and by that of what it is a link to
  };
  struct Output {
    std::string option, path;
    Kind kind = Kind::file;
    std::vector<std::string> names;
    std::vector<std::filesystem::path> places;
  };

  void write(const std::string& option, const std::string& path, Kind kind, std::vector<std::string> names);
  static bool holds_name(const Output& folder, const std::filesystem::path& file);
  static bool harms(const Output& output, const Input& input);
  static bool clash(const Output& a, const Output& b);
  static std::string harm_in_words(const Output& output, const Input& input);
  static std::string clash_in_words(const Output& output, const Output& other);
  std::string fault(const Output& output) const;
  bool will_be_there(const std::filesystem::path& folder) const;

  std::vector<Input> inputs_;
  std::vector<Output> outputs_;
  std::vector<Claim> claims_;
};

}  // namespace shatterbox::sandbox::run
