#include "sandbox/recording/recording_reader.h"

#include <cerrno>
#include <filesystem>

#include <fmt/format.h>

namespace shatterbox::sandbox::recording {

namespace {

constexpr std::uint64_t kMostSamples = 256;  // pictures that make a frame

std::string read_bytes(std::ifstream& stream, std::uint64_t place, std::uint64_t count) {
  std::string bytes(static_cast<std::size_t>(count), '\0');
  stream.clear();
  stream.seekg(static_cast<std::streamoff>(place));
  stream.read(bytes.data(), static_cast<std::streamsize>(count));
  if (!stream) throw Unreadable(fmt::format("it cannot be read: {}", std::strerror(errno)));
  return bytes;
}

[[noreturn]] void throw_damaged(std::uint64_t place, const char* what) {
  throw Unreadable(
      fmt::format("it is damaged at byte {}: {}; copy it again, or record it again", place, what));
}

void check_settings(const Settings& settings) {
  const auto is_side = [](std::uint32_t side) { return side >= 16 && side <= 8192 && side % 2 == 0; };
  if (!is_side(settings.width) || !is_side(settings.height) || settings.panels < 1 ||
      settings.panels > kMostPanels || settings.frames_per_second < 1 ||
      settings.frames_per_second > kMostFramesPerSecond)
    throw Unreadable("pictures that cannot be");
}

}  // namespace

RecordingReader::RecordingReader(const std::string& file) {
  std::error_code code;
  if (std::filesystem::is_directory(file, code)) throw Unreadable("it is a folder");
  errno = 0;
  stream_.open(file, std::ios::binary);
  if (!stream_) throw Unreadable(fmt::format("it cannot be read: {}", std::strerror(errno)));
  size_ = std::filesystem::file_size(file, code);
  if (code) throw Unreadable(fmt::format("it cannot be read: {}", code.message()));
  const std::string head = read_bytes(stream_, 0, std::min<std::uint64_t>(size_, kHeadSize));
  if (head.substr(0, kMagic.size()) != kMagic)
    throw Unreadable("it is no recording; shatterbox run SCENE --record FILE makes one");
  std::uint32_t version = 0;
  if (head.size() == kHeadSize) ByteReader(std::string_view(head).substr(kMagic.size()))(version);
  if (head.size() == kHeadSize && version != kVersion)
    throw Unreadable(
        fmt::format("it is a recording of version {}, and this program reads version {}: record it again",
                    version, kVersion));
  read_index();
}

std::string RecordingReader::read_part(std::uint64_t place, PartKind kind) {
  const std::uint64_t end = size_ - kTailSize, least = kPartHeadSize + kPartTailSize;
  if (place < kHeadSize || place > end || end - place < least) throw_damaged(place, "nothing is there");
  const std::string head = read_bytes(stream_, place, kPartHeadSize);
  ByteReader reader(head);
  PartKind found{};
  std::uint64_t count = 0;
  reader.choice(found, PartKind::index);
  reader(count);
  if (found != kind || count > end - place - least) throw_damaged(place, "another part should be there");
  std::string contents = read_bytes(stream_, place + kPartHeadSize, count + kPartTailSize);
  std::uint64_t hash = 0;
  ByteReader(std::string_view(contents).substr(static_cast<std::size_t>(count)))(hash);
  contents.resize(static_cast<std::size_t>(count));
  if (hash != hash_of_part(kind, contents)) throw_damaged(place, "its bytes are not those that were written");
  return contents;
}

void RecordingReader::read_index() {
  std::string tail;
  if (size_ >= kHeadSize + kTailSize) tail = read_bytes(stream_, size_ - kTailSize, kTailSize);
  if (tail.empty() || tail.substr(8) != kEnd)
    throw Unreadable(
        "its end is missing: the run that writes it is not over, or was cut short, or it was not copied "
        "wholly");
  std::uint64_t place = 0;
  ByteReader(std::string_view(tail).substr(0, 8))(place);
  const std::string index = read_part(place, PartKind::index);
  ByteReader in(index);
  pass_settings(in, settings_);
  check_settings(settings_);
  for (std::size_t count = in.count_of(1); count > 0; --count) {
    std::string bytes;
    in(bytes);
    ByteReader looks(bytes);
    looks_.push_back(take_looks(looks));
  }
  for (std::size_t count = in.count_of(2); count > 0; --count) {
    const std::uint64_t id = in.count();
    places_[id] = in.count();
  }
  frames_.resize(in.count_of(2));
  for (FrameEntry& frame : frames_) in.count(frame.place), in(frame.is_whole);
  if (!in.is_at_end() || (!frames_.empty() && !frames_.front().is_whole))
    throw_damaged(place, "the list of its frames makes no sense");
  readers_.resize(settings_.panels);
  next_ = frames_.size();
}

std::shared_ptr<const render::Mesh> RecordingReader::find_mesh(std::uint64_t id) {
  if (const auto kept = meshes_.find(id); kept != meshes_.end()) return kept->second;
  const auto place = places_.find(id);
  if (place == places_.end()) throw Unreadable("a body without a mesh");
  const std::string contents = read_part(place->second, PartKind::mesh);
  ByteReader in(contents);
  auto mesh = take_mesh(in);
  if (mesh->id != id || !in.is_at_end()) throw Unreadable("a mesh that is another one");
  meshes_[id] = mesh;
  return mesh;
}

Panels RecordingReader::read_next(std::size_t number) {
  const FrameEntry& entry = frames_[number];
  const std::string contents = read_part(entry.place, PartKind::frame);
  ByteReader in(contents);
  Panels panels(readers_.size());
  std::size_t draws = 0;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    if (entry.is_whole) readers_[i].forget();
    const std::uint64_t count = in.count();
    if (count == 0 || count > kMostSamples)
      throw_damaged(entry.place, "a frame of no pictures, or of too many");
    for (std::uint64_t sample = 0; sample < count; ++sample) {
      panels[i].push_back(readers_[i].take(in, looks_, [this](std::uint64_t id) { return find_mesh(id); }));
      draws += panels[i].back().draws.size();
      if (draws > kMostDraws) throw_damaged(entry.place, "too many bodies in one frame");
    }
  }
  if (!in.is_at_end()) throw_damaged(entry.place, "more than a frame");
  std::erase_if(meshes_, [](const auto& mesh) { return mesh.second.use_count() == 1; });
  return panels;
}

Panels RecordingReader::read(int number) {
  const auto wanted = static_cast<std::size_t>(number);
  if (wanted != next_) {
    next_ = wanted;
    while (!frames_[next_].is_whole) --next_;
  }
  for (; next_ < wanted; ++next_) (void)read_next(next_);
  ++next_;
  return read_next(wanted);
}

}  // namespace shatterbox::sandbox::recording
