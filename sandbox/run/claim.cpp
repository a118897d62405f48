#include "sandbox/run/claim.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace shatterbox::sandbox::run {

namespace {

/// Whether the open file is still the one of that name: who held it before removes it.
bool has_name(int file, const std::string& name) {
  struct stat opened = {}, named = {};
  return fstat(file, &opened) == 0 && stat(name.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

}  // namespace

Claim Claim::on_file(const std::string& file) {
  Claim claim;
  const std::string name = file + ".lock";
  for (;;) {
    const int opened = open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (opened < 0) return claim;
    if (flock(opened, LOCK_EX | LOCK_NB) != 0) {
      claim.is_refused_ = errno == EWOULDBLOCK;
      close(opened);
      if (!claim.is_refused_) unlink(name.c_str());
      return claim;
    }
    if (has_name(opened, name)) {
      claim.lock_file_ = name;
      claim.file_ = opened;
      return claim;
    }
    close(opened);
  }
}

Claim Claim::on_folder(const std::string& folder) {
  Claim claim;
  claim.file_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (claim.file_ >= 0 && flock(claim.file_, LOCK_EX | LOCK_NB) != 0)
    claim.is_refused_ = errno == EWOULDBLOCK;
  return claim;
}

Claim::Claim(Claim&& other) noexcept
    : lock_file_(std::exchange(other.lock_file_, {})),
      file_(std::exchange(other.file_, -1)),
      is_refused_(other.is_refused_) {}

Claim::~Claim() {
  if (!lock_file_.empty()) unlink(lock_file_.c_str());  // while it is held: nobody else's goes
  if (file_ >= 0) close(file_);
}

}  // namespace shatterbox::sandbox::run
