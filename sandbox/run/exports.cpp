#include "sandbox/run/exports.h"

#include <filesystem>

#include <fmt/format.h>

#include "sandbox/report/obj_frames.h"

namespace shatterbox::sandbox::run {

Exports::Exports(const Job& job, view::View& view, int first) : job_(job), view_(view), first_(first) {
  const Options& options = job.options;
  const render::Size& size = job.painter.size;
  if (!options.model.empty())
    model_.emplace(*job.scene, *job.built, options.frames_per_second,
                   static_cast<double>(size.width) / size.height);
  if (!options.truth_folder.empty()) bodies_.emplace(options.truth_folder);
  if (!options.tables_folder.empty()) tables_.emplace(options.tables_folder);
}

std::string Exports::add(const view::Moment& moment, int number) {
  const std::string& meshes = job_.options.meshes_folder;
  if (model_) model_->add(moment, view_.camera_at(moment));
  if (!meshes.empty() && number >= first_)
    if (std::string fault = report::write_obj_frame(meshes, number, moment.bodies, moment.time);
        !fault.empty())
      return fault;
  if (bodies_) bodies_->add(moment.time, moment.bodies);
  return tables_ ? tables_->add(number, moment.film, moment.time, moment.bodies) : std::string();
}

std::string Exports::close() {
  std::string fault;
  if (model_) fault = model_->write(job_.options.model);
  if (bodies_ && fault.empty()) fault = bodies_->close(job_.built->world);
  if (tables_ && fault.empty()) fault = tables_->close(job_.built->world);
  return fault;
}

std::vector<std::string> export_outputs(const Options& options) {
  std::vector<std::string> outputs;
  for (const std::string& output :
       {options.meshes_folder, options.model, options.tables_folder, options.truth_folder, options.recording})
    if (!output.empty()) outputs.push_back(output);
  return outputs;
}

void check_exports(const Options& options, scene::Problems& problems) {
  if (!options.model.empty() && std::filesystem::path(options.model).extension() != ".glb")
    scene::book(problems, scene::Place{"--export", 0, 0},
                fmt::format("{}: the name of a model must end in .glb", options.model),
                "that is glTF 2.0 in one file; most programs that read .gltf read it too");
  if (!options.recording.empty() && !options.stills.empty())
    scene::book(problems, scene::Place{"--stills", 0, 0}, "a recording holds the whole film",
                "leave --stills out; shatterbox render RECORDING --frames 30:31 draws one frame of it");
}

}  // namespace shatterbox::sandbox::run
