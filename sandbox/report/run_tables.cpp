#include "sandbox/report/run_tables.h"

namespace shatterbox::sandbox::report {

namespace {

const std::vector<Column> kBodyColumns{{"body", "1"},    {"name", ""},   {"parent", "1"},   {"original", "1"},
                                       {"material", ""}, {"motion", ""}, {"mass_kg", "kg"}, {"birth_s", "s"},
                                       {"gone_s", "s"},  {"x_m", "m"},   {"y_m", "m"},      {"z_m", "m"},
                                       {"qw", "1"},      {"qx", "1"},    {"qy", "1"},       {"qz", "1"}};
const std::vector<Column> kTrajectoryColumns{
    {"frame", "1"},        {"film_s", "s"},      {"time_s", "s"},   {"body", "1"},     {"x_m", "m"},
    {"y_m", "m"},          {"z_m", "m"},         {"qw", "1"},       {"qx", "1"},       {"qy", "1"},
    {"qz", "1"},           {"vx_m_s", "m/s"},    {"vy_m_s", "m/s"}, {"vz_m_s", "m/s"}, {"wx_rad_s", "rad/s"},
    {"wy_rad_s", "rad/s"}, {"wz_rad_s", "rad/s"}};
const std::vector<Column> kImpactColumns{{"time_s", "s"},       {"body", "1"},       {"name", ""},
                                         {"impulse_ns", "N s"}, {"duration_s", "s"}, {"stress_pa", "Pa"},
                                         {"strength_pa", "Pa"}, {"ratio", "1"},      {"verdict", ""},
                                         {"x_m", "m"},          {"y_m", "m"},        {"z_m", "m"}};
const std::vector<Column> kBreakColumns{{"time_s", "s"},
                                        {"body", "1"},
                                        {"name", ""},
                                        {"pieces", "1"},
                                        {"new_area_m2", "m2"},
                                        {"grain_share", "1"},
                                        {"fracture_energy_j", "J"},
                                        {"elastic_energy_j", "J"},
                                        {"generation", "1"},
                                        {"merged", "1"},
                                        {"x_m", "m"},
                                        {"y_m", "m"},
                                        {"z_m", "m"}};

void append(std::vector<Cell>& cells, const Vec3& v) {
  cells.insert(cells.end(), {v.x(), v.y(), v.z()});
}

void append(std::vector<Cell>& cells, const Pose& pose) {
  append(cells, pose.translation);
  const Quat& q = pose.rotation;
  cells.insert(cells.end(), {q.w(), q.x(), q.y(), q.z()});
}

Cell number_of(body::BodyId id) {
  return id == 0 ? Cell{} : Cell{static_cast<long>(id)};
}

const char* name_of(body::Motion motion) {
  return motion == body::Motion::dynamic    ? "dynamic"
         : motion == body::Motion::scripted ? "scripted"
                                            : "static";
}

}  // namespace

BodyTable::BodyTable(const std::string& folder) : file_(folder, "bodies", kBodyColumns) {}

void BodyTable::add(double time, std::span<const body::Body> bodies) {
  std::set<body::BodyId> present;
  for (const body::Body& body : bodies) {
    present.insert(body.id);
    lives_.try_emplace(body.id, Life{body});
  }
  for (const body::BodyId id : present_)
    if (present.count(id) == 0) lives_[id].gone = time;
  present_ = std::move(present);
}

std::string BodyTable::close(const world::World& world) {
  for (const auto& [id, life] : lives_) {
    const world::Ancestry ancestry = world.ancestry(id);
    const body::Body& body = life.at_birth;
    std::vector<Cell> cells{static_cast<long>(id),
                            body.name,
                            number_of(ancestry.parent),
                            number_of(ancestry.original),
                            world.material(body.material).name,
                            std::string(name_of(body.motion)),
                            body.shape->mass,
                            ancestry.birth_time,
                            life.gone < 0.0 ? Cell{} : Cell{life.gone}};
    append(cells, body.pose);
    file_.add_row(cells);
  }
  return file_.close();
}

RunTables::RunTables(const std::string& folder)
    : bodies_(folder),
      trajectories_(folder, "trajectories", kTrajectoryColumns),
      impacts_(folder, "impacts", kImpactColumns),
      breaks_(folder, "breaks", kBreakColumns) {}

std::string RunTables::add(int frame, double film, double time, std::span<const body::Body> bodies) {
  bodies_.add(time, bodies);
  for (const body::Body& body : bodies) {
    if (body.motion == body::Motion::fixed) continue;
    std::vector<Cell> cells{static_cast<long>(frame), film, time, static_cast<long>(body.id)};
    append(cells, body.pose);
    append(cells, body.velocity);
    append(cells, body.angular_velocity);
    trajectories_.add_row(cells);
  }
  return trajectories_.fault();
}

std::string RunTables::close(const world::World& world) {
  for (const world::ImpactRow& row : world.report().impacts) {
    std::vector<Cell> cells{row.time,     static_cast<long>(row.id),
                            row.body,     row.impulse,
                            row.duration, row.stress,
                            row.strength, row.ratio,
                            row.verdict};
    append(cells, row.place);
    impacts_.add_row(cells);
  }
  for (const world::BreakRow& row : world.report().breaks) {
    std::vector<Cell> cells{row.time,
                            static_cast<long>(row.id),
                            row.body,
                            static_cast<long>(row.pieces),
                            row.new_area,
                            row.grain_share,
                            row.fracture_energy,
                            row.elastic_energy,
                            static_cast<long>(row.generation),
                            static_cast<long>(row.merged)};
    append(cells, row.place);
    breaks_.add_row(cells);
  }
  for (TableFile* file : {&trajectories_, &impacts_, &breaks_})
    if (std::string fault = file->close(); !fault.empty()) return fault;
  return bodies_.close(world);
}

}  // namespace shatterbox::sandbox::report
