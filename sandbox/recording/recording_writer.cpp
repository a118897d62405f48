#include "sandbox/recording/recording_writer.h"

#include <cerrno>
#include <filesystem>

#include <fmt/format.h>

namespace shatterbox::sandbox::recording {

namespace {

constexpr std::size_t kBetweenWholes = 60;  // frames: a range begins at most so many before its first

}  // namespace

RecordingWriter::RecordingWriter(std::string file, Settings settings)
    : file_(std::move(file)),
      part_file_(file_ + ".part"),
      settings_(std::move(settings)),
      stream_(part_file_, std::ios::binary),
      writers_(settings_.panels) {
  ByteWriter head;
  head(kVersion);
  stream_ << kMagic << head.bytes();
  size_ = kHeadSize;
}

std::string RecordingWriter::fault() const {
  return stream_ ? std::string() : fmt::format("{} cannot be written: {}", file_, std::strerror(errno));
}

void RecordingWriter::put_part(PartKind kind, std::string_view contents) {
  ByteWriter head, tail;
  head(static_cast<std::uint8_t>(kind));
  head(static_cast<std::uint64_t>(contents.size()));
  tail(hash_of_part(kind, contents));
  stream_ << head.bytes() << contents << tail.bytes();
  size_ += kPartHeadSize + contents.size() + kPartTailSize;
}

void RecordingWriter::put_new_meshes(const Panels& panels) {
  for (const auto& pictures : panels) {
    for (const render::Frame& picture : pictures) {
      for (const render::Draw& draw : picture.draws) {
        if (!meshes_.try_emplace(draw.mesh->id, size_).second) continue;
        ByteWriter out;
        put_mesh(*draw.mesh, out);
        put_part(PartKind::mesh, out.bytes());
      }
    }
  }
}

std::string RecordingWriter::add(const Panels& panels) {
  std::size_t draws = 0;
  for (const auto& pictures : panels)
    for (const render::Frame& picture : pictures) draws += picture.draws.size();
  if (draws > kMostDraws)
    return fmt::format("{}: frame {} draws {} bodies in all its pictures, and a recording holds at most {}",
                       file_, frames_.size(), draws, kMostDraws);
  errno = 0;
  put_new_meshes(panels);
  const bool is_whole = frames_.size() % kBetweenWholes == 0;
  ByteWriter out;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    if (is_whole) writers_[i].forget();
    out.count(panels[i].size());
    for (const render::Frame& picture : panels[i]) writers_[i].put(picture, looks_, out);
  }
  frames_.push_back({size_, is_whole});
  put_part(PartKind::frame, out.bytes());
  return fault();
}

std::string RecordingWriter::close() {
  ByteWriter out, tail;
  pass_settings(out, settings_);
  out.count(looks_.all().size());
  for (const std::string& looks : looks_.all()) out(looks);
  out.count(meshes_.size());
  for (const auto& [id, place] : meshes_) out.count(id), out.count(place);
  out.count(frames_.size());
  for (const FrameEntry& frame : frames_) out.count(frame.place), out(frame.is_whole);
  errno = 0;
  tail(size_);
  put_part(PartKind::index, out.bytes());
  stream_ << tail.bytes() << kEnd;
  stream_.close();
  if (std::string sentence = fault(); !sentence.empty()) return sentence;
  std::error_code code;
  std::filesystem::rename(part_file_, file_, code);
  return code ? fmt::format("{} cannot be written: {}", file_, code.message()) : std::string();
}

}  // namespace shatterbox::sandbox::recording
