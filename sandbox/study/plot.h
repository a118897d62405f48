// Error against run time as a picture, by gnuplot.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sandbox/study/study.h"

namespace shatterbox::sandbox::study {

/// Draws the first error of every table against run time, both on logarithmic axes, to NAME.png and NAME.svg
/// in `folder`; the default's rows are ringed. Nothing is drawn where no table is to be plotted. A sentence
/// if it cannot (no gnuplot), else empty.
std::string draw_plot(const std::vector<Table>& tables, const std::string& title, const std::string& name,
                      const std::filesystem::path& folder);

/// The same for a figure: NAME_FIGURE.png and .svg.
std::string draw_figure(const Figure& figure, const std::string& name, const std::filesystem::path& folder);

/// The commands for gnuplot; empty where there is nothing to draw.
std::string plot_commands(const std::vector<Table>& tables, const std::string& title,
                          const std::string& name);

}  // namespace shatterbox::sandbox::study
