// `karst cave from-survey`: makes a cave of a survey.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// `cave` is the command `karst cave`.
void add_from_survey_command(CLI::App& cave);

}  // namespace karst::tools
