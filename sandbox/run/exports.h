// What a run writes for other programs beside its film: an animated model, OBJ meshes, tables, and who
// is who in the truth images.
#pragma once

#include <optional>
#include <string>

#include "sandbox/model/model_film.h"
#include "sandbox/report/run_tables.h"
#include "sandbox/run/job.h"
#include "sandbox/view/view.h"

namespace shatterbox::sandbox::run {

class Exports {
 public:
  /// `job` and `view` must outlive it. An earlier run has written the meshes of the frames below `first`.
  Exports(const Job& job, view::View& view, int first);

  /// Frame `number` of the film. A sentence if it cannot be written, else empty.
  std::string add(const view::Moment& moment, int number);

  /// After the last frame.
  std::string close();

 private:
  const Job& job_;
  view::View& view_;
  int first_;
  std::optional<model::ModelFilm> model_;
  std::optional<report::RunTables> tables_;
  std::optional<report::BodyTable> bodies_;  // who the ids of truth images are
};

/// What is asked for of a run's exports, by the option's names: for the closing words.
std::vector<std::string> export_outputs(const Options& options);

/// Wrong endings, and what one export cannot hold, go to `problems`.
void check_exports(const Options& options, scene::Problems& problems);

}  // namespace shatterbox::sandbox::run
