// What one process writes, no other one writes at the same time.
#pragma once

#include <string>

namespace shatterbox::sandbox::run {

/// Held by this process until the object goes, however the process ends. Where the file system knows no locks
/// everybody gets everything.
class Claim {
 public:
  /// Of a file: by NAME.lock beside it, which goes with the object.
  static Claim on_file(const std::string& file);
  /// Of a folder that is there: by itself.
  static Claim on_folder(const std::string& folder);

  ~Claim();
  Claim(Claim&& other) noexcept;
  Claim& operator=(Claim&&) = delete;

  /// Whether another process holds it.
  bool is_refused() const { return is_refused_; }

 private:
  Claim() = default;

  std::string lock_file_;  // empty: none
  int file_ = -1;          // its number
  bool is_refused_ = false;
};

}  // namespace shatterbox::sandbox::run
