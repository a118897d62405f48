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
    curves += fmt::format("{}${} using 1:2 with linespoints lt {} pt 7 ps 0.5 lw 1.5 title {}",
                          curves.empty() ? "plot " : ", ", block, number,
                          quoted(table.name + ": " + table.error_names[0]));
    if (!has_default) continue;
    data += data_block(fmt::format("{}d", block), table, true);
    curves += fmt::format(", ${}d using 1:2 with points lt {} pt 6 ps 1.8 lw 2 notitle", block, number);
  }
  if (number == 0) return {};
  std::string text = data +
                     "set logscale xy\nset format x \"10^{%L}\"\nset format y \"10^{%L}\"\n"
                     "set xlabel \"processor time, s\"\nset ylabel \"error\"\nset grid lc rgb \"#dddddd\"\n"
                     "set key outside right noenhanced\nset title noenhanced " +
                     quoted(title + " (ringed: the default)") + "\n";
  const auto output = [&](const char* terminal, const char* ending) {
    return fmt::format("set terminal {}\nset output {}\n{}\nunset output\n", terminal, quoted(name + ending),
                       curves);
  };
  text += output("pngcairo size 900,520 font \"sans,10\"", ".png");
  text += output("svg size 900,520 font \"sans,12\"", ".svg");
  return text;
}

std::string draw_plot(const std::vector<Table>& tables, const std::string& title, const std::string& name,
                      const std::filesystem::path& folder) {
  const std::string commands = plot_commands(tables, title, name);
  if (commands.empty()) return "nothing to plot: no row has both an error and a time";
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

}  // namespace shatterbox::sandbox::study
