#include "sandbox/study/plot.h"

#include <sys/wait.h>

#include <cmath>
#include <cstdio>

#include <fmt/format.h>

namespace shatterbox::sandbox::study {

namespace {

/// Errors of nothing but rounding are drawn at the lower edge.
constexpr double kLeastDrawn = 1e-14;

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

bool is_drawn(const Row& row) {
  return !row.errors.empty() && std::isfinite(row.errors[0]) && row.seconds > 0.0;
}

std::string data_block(const std::string& name, const Table& table, bool is_default_only) {
  std::string text = fmt::format("${} << EOD\n", name);
  for (const Row& row : table.rows)
    if (is_drawn(row) && (row.is_default || !is_default_only))
      text += fmt::format("{:.6g} {:.6g}\n", row.seconds, std::max(std::abs(row.errors[0]), kLeastDrawn));
  return text + "EOD\n";
}

/// A sentence if gnuplot cannot draw it, else empty.
std::string run_gnuplot(const std::string& commands, const std::filesystem::path& folder) {
  // The shell goes to the folder by its own variable, so that no name needs to be quoted.
  setenv("SHATTERBOX_PLOTS", folder.c_str(), 1);
  std::FILE* gnuplot = popen("cd \"$SHATTERBOX_PLOTS\" && exec gnuplot 2>/dev/null", "w");
  if (gnuplot == nullptr) return "no plot: gnuplot could not be started";
  std::fwrite(commands.data(), 1, commands.size(), gnuplot);
  const int status = pclose(gnuplot);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    return "no plot: gnuplot is not installed (Debian: apt install gnuplot-nox)";
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return "no plot: gnuplot could not draw it";
  return {};
}

/// The same curves as PNG and as SVG.
std::string to_both(const std::string& curves, const std::string& name) {
  const auto output = [&](const char* terminal, const char* ending) {
    return fmt::format("set terminal {}\nset output {}\n{}\nunset output\n", terminal, quoted(name + ending),
                       curves);
  };
  return output("pngcairo size 720,540 font \"sans,10\"", ".png") +
         output("svg size 720,540 font \"sans,12\"", ".svg");
}

}  // namespace

std::string plot_commands(const std::vector<Table>& tables, const std::string& title,
                          const std::string& name) {
  std::string data, curves;
  int number = 0;
  for (const Table& table : tables) {
    bool has_rows = false, has_default = false;
    for (const Row& row : table.rows) {
      has_rows |= is_drawn(row);
      has_default |= is_drawn(row) && row.is_default;
    }
    if (!has_rows || !table.is_plotted) continue;
    ++number;
    const std::string block = fmt::format("t{}", number);
    data += data_block(block, table, false);
    curves += fmt::format("{}${} using 1:2 with linespoints lt {} ps 0.5 lw 1.5 title {}",
                          curves.empty() ? "plot " : ", ", block, number,
                          quoted(table.name + ": " + table.error_names[0]));
    if (!has_default) continue;
    data += data_block(fmt::format("{}d", block), table, true);
    curves += fmt::format(", ${}d using 1:2 with points lt {} pt 6 ps 1.8 lw 2 notitle", block, number);
  }
  if (number == 0) return {};
  std::string text = data +
                     "set logscale xy\nset format x \"10^{%L}\"\nset format y \"10^{%L}\"\n"
                     "set xlabel \"processor time, s (ringed: the default)\"\nset ylabel \"error\"\nset grid "
                     "lc rgb \"#dddddd\"\n"
                     "set key below maxcols 3 noenhanced\nset title noenhanced " +
                     quoted(title) + "\n";
  return text + to_both(curves, name);
}

std::string draw_plot(const std::vector<Table>& tables, const std::string& title, const std::string& name,
                      const std::filesystem::path& folder) {
  const std::string commands = plot_commands(tables, title, name);
  if (commands.empty()) return {};
  return run_gnuplot(commands, folder);
}

std::string draw_figure(const Figure& figure, const std::string& name, const std::filesystem::path& folder) {
  std::string commands, curves;
  for (std::size_t i = 0; i < figure.curves.size(); ++i) {
    const Figure::Curve& curve = figure.curves[i];
    commands += fmt::format("$c{} << EOD\n", i);
    for (std::size_t k = 0; k < curve.x.size(); ++k)
      if (std::isfinite(curve.y[k])) commands += fmt::format("{:.6g} {:.6g}\n", curve.x[k], curve.y[k]);
    commands += "EOD\n";
    curves += fmt::format("{}$c{} using 1:2 with linespoints lt {} pt 7 ps 0.4 lw 1.5 title {}",
                          i == 0 ? "plot " : ", ", i, i + 1, quoted(curve.name));
  }
  if (curves.empty()) return {};
  commands += fmt::format(
      "{}{}set xlabel {} noenhanced\nset ylabel {} noenhanced\nset grid lc rgb \"#dddddd\"\n"
      "set key below maxcols 3 noenhanced\nset title {} noenhanced\n",
      figure.is_x_logarithmic ? "set logscale x\n" : "", figure.is_y_logarithmic ? "set logscale y\n" : "",
      quoted(figure.x_label), quoted(figure.y_label), quoted(figure.title));
  return run_gnuplot(commands + to_both(curves, name + "_" + figure.name), folder);
}

}  // namespace shatterbox::sandbox::study
