#include <charconv>
#include <optional>

#include <fmt/format.h>

#include "sandbox/scene/nearest_name.h"
#include "sandbox/scene/read_body.h"

namespace shatterbox::sandbox::scene {

std::vector<std::string> body_names(const SceneDescription& scene) {
  std::vector<std::string> names;
  for (const BodyEntry& body : scene.bodies) names.push_back(body.name);
  return names;
}

std::optional<BodyRef> read_body_ref(TableReader& reader, const TomlValue& value,
                                     const SceneDescription& scene) {
  if (const int exact = find_body(scene, value.text); exact >= 0) return BodyRef{exact, -1};
  const std::size_t bracket = value.text.find('[');
  const std::string name = value.text.substr(0, bracket);
  const int found = find_body(scene, name);
  if (found < 0) {
    reader.add_problem(value.place, fmt::format("there is no body \"{}\"", name),
                       hint_for_name(name, body_names(scene), "bodies"));
    return std::nullopt;
  }
  const int copies = scene.bodies[static_cast<std::size_t>(found)].repeat.total();
  int number = 0;
  const char* const end = value.text.data() + value.text.size();
  const auto parsed = std::from_chars(value.text.data() + bracket + 1, end, number);
  if (parsed.ec != std::errc{} || parsed.ptr + 1 != end || *parsed.ptr != ']' || number < 1 ||
      number > copies) {
    reader.add_problem(value.place, fmt::format("there is no \"{}\"", value.text),
                       copies > 1 ? fmt::format("its copies are {0}[1] to {0}[{1}]", name, copies)
                                  : fmt::format("\"{}\" has no copies", name));
    return std::nullopt;
  }
  return BodyRef{found, copies > 1 ? number - 1 : -1};
}

}  // namespace shatterbox::sandbox::scene
