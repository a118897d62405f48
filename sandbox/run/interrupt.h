// Ctrl-C asks a run to end in order: the video is closed and plays. A second one, half a second later or more,
// ends the program at once.
#pragma once

namespace shatterbox::sandbox::run {

/// While a run is read and made there is nothing to finish: SIGINT and SIGTERM end the program at once, even
/// where the shell that started us ignores them (as it does for background jobs).
void heed_interrupts();

/// Catches SIGINT and SIGTERM, even where the shell that started us ignores them (as it does for background
/// jobs); SIGPIPE is ignored.
void catch_interrupts();

/// Whether one came. Any thread.
bool is_interrupted();

}  // namespace shatterbox::sandbox::run
