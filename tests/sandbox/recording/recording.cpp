// Pictures come back from a recording as they went in, and what is no recording, or a damaged one, is told.
#include <catch2/catch.hpp>
#include <fstream>

#include "sandbox/recording/fields.h"
#include "sandbox/recording/recording_reader.h"
#include "sandbox/recording/recording_writer.h"
#include "tests/sandbox/run/folder.h"

using namespace shatterbox;
using namespace shatterbox::sandbox::recording;
using sandbox::run::Folder;
using sandbox::run::read_text;

namespace {

/// How many bytes of a structure without pointers do not come back: those that are no part of any field.
template <class T, class Pass>
int count_lost_bytes(const Pass& pass, const std::vector<std::size_t>& choices) {
  T in, out;
  std::memset(static_cast<void*>(&in), 0x3f, sizeof in);  // floats are 0.747
  std::memset(static_cast<void*>(&out), 0, sizeof out);
  for (const std::size_t place : choices) reinterpret_cast<unsigned char*>(&in)[place] = 1;
  ByteWriter writer;
  pass(writer, in);
  ByteReader reader(writer.bytes());
  pass(reader, out);
  CHECK(reader.is_at_end());
  int lost = 0;
  for (std::size_t i = 0; i < sizeof in; ++i)
    lost += reinterpret_cast<unsigned char*>(&in)[i] != reinterpret_cast<unsigned char*>(&out)[i] ? 1 : 0;
  return lost;
}

std::shared_ptr<render::Mesh> make_strip(std::uint64_t id, unsigned triangles) {
  auto mesh = std::make_shared<render::Mesh>();
  mesh->id = id;
  mesh->thickness = 0.001F * static_cast<float>(id);
  for (unsigned i = 0; i < triangles + 2; ++i)
    mesh->positions.emplace_back(0.1F * static_cast<float>(i), i % 2 == 0 ? -0.0F : 1.0F, 1e-40F);
  for (unsigned i = 0; i < triangles; ++i) mesh->triangles.emplace_back(i, i + 1 + i % 2, i + 2 - i % 2);
  mesh->parts.assign(triangles, 2);
  mesh->cracks.assign(triangles, render::kCrackEdge1);
  mesh->pattern_positions = mesh->positions;
  return mesh;
}

render::Draw make_draw(std::shared_ptr<const render::Mesh> mesh, std::uint32_t id, float x) {
  render::Draw draw;
  draw.mesh = std::move(mesh);
  draw.id = id;
  draw.world_from_body[3] = {x, 0.5F * x, 2.0F, 1.0F};
  draw.looks = {render::glass(), render::stone({0.1F, 0.2F, 0.3F})};
  return draw;
}

/// A film in which bodies rest, move, break, change their colours and go.
std::vector<Panels> make_film(int frames) {
  const auto big = make_strip(1, 5), small = make_strip((1ULL << 32U) + 1, 2), marker = make_strip(7, 3);
  std::vector<Panels> film;
  for (int i = 0; i < frames; ++i) {
    render::Frame picture;
    const auto x = static_cast<float>(i);
    picture.caption = "frame " + std::to_string(i / 3);
    picture.camera.position.x = i < 5 ? 1.0F : x;
    if (i > 3) picture.ground.reset();
    picture.draws.push_back(make_draw(big, 1, 0.0F));
    if (i < 4) picture.draws.push_back(make_draw(big, 2, x));
    for (std::uint32_t piece = 10; i >= 4 && piece < 13 + static_cast<std::uint32_t>(i % 3); ++piece)
      picture.draws.push_back(make_draw(small, piece, piece == 11 ? 3.0F : x));
    picture.draws.push_back(make_draw(big, 3, 1.0F));
    if (i % 4 == 1) picture.draws.back().looks.pop_back();
    if (i % 3 != 0)
      picture.draws.back().scalars =
          std::make_shared<const std::vector<float>>(big->positions.size(), static_cast<float>(i / 5));
    for (int k = 0; k < i % 3; ++k) picture.draws.push_back(make_draw(marker, 0, x));
    if (i % 5 == 2) std::swap(picture.draws.front(), picture.draws.back());
    render::Frame other = picture;
    other.draws.pop_back();
    other.title = {"other", 0.5F};
    film.push_back({{picture, other}, {other}});
  }
  return film;
}

void check_equal(const render::Mesh& a, const render::Mesh& b) {
  CHECK(a.id == b.id);
  CHECK(a.triangles == b.triangles);
  ByteWriter first, second;  // to the bit
  pass_mesh(first, a), pass_mesh(second, b);
  CHECK(first.bytes() == second.bytes());
}

void check_equal(const render::Frame& a, const render::Frame& b) {
  ByteWriter first, second;
  pass_stage(first, a), pass_stage(second, b);
  CHECK(first.bytes() == second.bytes());
  REQUIRE(a.draws.size() == b.draws.size());
  for (std::size_t i = 0; i < a.draws.size(); ++i) {
    const render::Draw &one = a.draws[i], &other = b.draws[i];
    check_equal(*one.mesh, *other.mesh);
    CHECK(one.world_from_body == other.world_from_body);
    CHECK(one.id == other.id);
    CHECK(one.colour_index == other.colour_index);
    CHECK(one.casts_shadow == other.casts_shadow);
    CHECK((one.scalars != nullptr) == (other.scalars != nullptr));
    if (one.scalars && other.scalars) CHECK(*one.scalars == *other.scalars);
    ByteWriter looks, other_looks;
    put_looks(one.looks, looks), put_looks(other.looks, other_looks);
    CHECK(looks.bytes() == other_looks.bytes());
  }
}

void check_equal(const Panels& a, const Panels& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    REQUIRE(a[i].size() == b[i].size());
    for (std::size_t k = 0; k < a[i].size(); ++k) check_equal(a[i][k], b[i][k]);
  }
}

std::string record(const Folder& folder, const std::vector<Panels>& film) {
  Settings settings;
  settings.scene = "strips";
  settings.panels = 2;
  const std::string file = (folder / "film.rec").string();
  sandbox::run::fs::remove(file);
  RecordingWriter writer(file, settings);
  for (const Panels& panels : film) CHECK(writer.add(panels).empty());
  CHECK_FALSE(sandbox::run::fs::exists(file));
  CHECK(writer.close().empty());
  CHECK_FALSE(sandbox::run::fs::exists(file + ".part"));
  return file;
}

/// What is said of a file; empty if all its frames can be read.
std::string complaint_about(const std::string& file) {
  try {
    RecordingReader reader(file);
    for (int i = 0; i < reader.frame_count(); ++i) (void)reader.read(i);
  } catch (const Unreadable& fault) {
    return fault.what();
  }
  return {};
}

/// In place: a file that is made anew each time costs a disk's time.
void put_byte(const std::string& file, std::size_t place, char byte) {
  std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
  stream.seekp(static_cast<std::streamoff>(place));
  stream.put(byte);
}

}  // namespace

TEST_CASE("every field of looks and cameras and lights comes back") {
  const auto look = [](auto& archive, auto& value) { pass_look(archive, value); };
  const auto camera = [](auto& archive, auto& value) { pass_camera(archive, value); };
  const auto lights = [](auto& archive, auto& value) { pass_lights(archive, value); };
  const auto ground = [](auto& archive, auto& value) { pass_ground(archive, value); };
  const auto backdrop = [](auto& archive, auto& value) { pass_backdrop(archive, value); };
  // Beside a byte of choice or of yes and no lie three of padding.
  CHECK(count_lost_bytes<render::Look>(look, {offsetof(render::Look, pattern)}) == 3);
  CHECK(count_lost_bytes<render::Camera>(camera, {}) == 0);
  CHECK(count_lost_bytes<render::Lights>(lights, {offsetof(render::Lights, casts_shadow)}) == 3);
  CHECK(count_lost_bytes<render::Ground>(ground, {offsetof(render::Ground, pattern)}) == 3);
  CHECK(count_lost_bytes<render::Backdrop>(backdrop, {}) == 0);
}

TEST_CASE("numbers come back to the bit and those that are none are refused") {
  ByteWriter out;
  const std::vector<std::uint64_t> numbers{0, 1, 127, 128, 300, 1ULL << 32U, (1ULL << 62U) + 5};
  for (const std::uint64_t number : numbers) out.count(number);
  out(-0.0F), out(1e-45F), out(std::string("text"));
  ByteReader in(out.bytes());
  for (const std::uint64_t number : numbers) CHECK(in.count() == number);
  float zero = 1.0F, least = 0.0F;
  std::string text;
  in(zero), in(least), in(text);
  CHECK(std::signbit(zero));
  CHECK(least == 1e-45F);
  CHECK(text == "text");
  CHECK(in.is_at_end());
  CHECK_THROWS_AS(in(zero), Unreadable);
  ByteWriter nan, many;
  nan(std::numeric_limits<float>::quiet_NaN());
  ByteReader no_number(nan.bytes());
  CHECK_THROWS_AS(no_number(zero), Unreadable);
  many.count(1ULL << 60U);
  std::vector<float> values;
  ByteReader too_many(many.bytes());
  CHECK_THROWS_AS(too_many.array(values), Unreadable);
}

TEST_CASE("a film comes back picture by picture from its begin and from any frame on") {
  const Folder folder;
  const std::vector<Panels> film = make_film(150);
  RecordingReader reader(record(folder, film));
  REQUIRE(reader.frame_count() == 150);
  CHECK(reader.settings().scene == "strips");
  for (int i = 0; i < 150; ++i) check_equal(reader.read(i), film[static_cast<std::size_t>(i)]);
  for (const int i : {149, 59, 60, 61, 7, 7, 120, 119, 0, 4})
    check_equal(reader.read(i), film[static_cast<std::size_t>(i)]);
}

TEST_CASE("what is not new in a picture takes no place") {
  const Folder folder;
  const render::Frame picture = make_film(4).back().front().front();
  std::vector<Panels> film(61, Panels{{picture}, {picture, picture}});
  const auto size_of = [&] { return sandbox::run::fs::file_size(record(folder, film)); };
  const auto all = size_of();
  film.resize(60);
  const auto without_whole = size_of();
  film.resize(59);
  CHECK(all - without_whole > 600);  // the sixty-first is told wholly
  CHECK(without_whole - size_of() < 40);
}

TEST_CASE("a recording with any byte changed or any end missing is refused in words") {
  const Folder folder;
  const std::string file = record(folder, make_film(6)), good = read_text(file);
  REQUIRE(complaint_about(file).empty());
  for (std::size_t i = 0; i < good.size(); ++i) {
    put_byte(file, i, static_cast<char>(good[i] ^ (1 << i % 8)));
    INFO("byte " << i << " of " << good.size());
    CHECK_FALSE(complaint_about(file).empty());
    put_byte(file, i, good[i]);
  }
  put_byte(file, 8, 3);
  CHECK(complaint_about(file).find("version 3") != std::string::npos);
  put_byte(file, 8, 2);
  REQUIRE(complaint_about(file).empty());
  for (std::size_t size = good.size(); size-- > 0;) {
    sandbox::run::fs::resize_file(file, size);
    INFO("the first " << size << " bytes of " << good.size());
    const bool is_begun = size >= kMagic.size();
    CHECK(complaint_about(file).find(is_begun ? "its end is missing" : "no recording") != std::string::npos);
  }
}
