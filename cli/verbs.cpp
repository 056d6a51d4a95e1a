// cli/verbs.cpp
#include "cli/verbs.h"

#include "cli/bench/bench_verb.h"
#include "cli/check/check_verb.h"
#include "cli/chronogram/chronogram_verb.h"
#include "cli/ctl/ctl_verb.h"
#include "cli/cut/cut_verb.h"
#include "cli/doctor/doctor_verb.h"
#include "cli/echo/echo_verb.h"
#include "cli/export/export_verb.h"
#include "cli/film/film_verb.h"
#include "cli/get/get_verb.h"
#include "cli/hz/hz_verb.h"
#include "cli/info/info_verb.h"
#include "cli/keys/keys_verb.h"
#include "cli/lab/lab_verb.h"
#include "cli/list/list_verb.h"
#include "cli/merge/merge_verb.h"
#include "cli/new/new_verb.h"
#include "cli/play/play_verb.h"
#include "cli/plot/plot_verb.h"
#include "cli/record/record_verb.h"
#include "cli/recover/recover_verb.h"
#include "cli/resim/resim_verb.h"
#include "cli/run/run_verb.h"
#include "cli/schema/schema_verb.h"
#include "cli/simulate/simulate_verb.h"
#include "cli/test/test_verb.h"

namespace cordis::cli {

void add_verbs(CommandLine& line) {
  add_run_verb(line);
  add_record_verb(line);
  add_play_verb(line);
  add_simulate_verb(line);
  add_resim_verb(line);
  add_export_verb(line);
  add_film_verb(line);
  add_chronogram_verb(line);
  add_plot_verb(line);
  add_list_verb(line);
  add_echo_verb(line);
  add_hz_verb(line);
  add_get_verb(line);
  add_ctl_verb(line);
  add_check_verb(line);
  add_new_verb(line);
  add_schema_verb(line);
  add_info_verb(line);
  add_cut_verb(line);
  add_merge_verb(line);
  add_recover_verb(line);
  add_keys_verb(line);
  add_doctor_verb(line);
  add_bench_verb(line);
  add_lab_verb(line);
  add_test_verb(line);
  line.examples(
      "`cordis VERB --help` explains a verb.\n\n"
      "Examples:\n"
      "  cordis run launch_configs/plucked_string.yaml\n"
      "  cordis ctl launch_configs/plucked_string.yaml pause\n"
      "  cordis check launch_configs/scenes/plucked_string.yaml\n"
      "  cordis doctor\n"
      "  cordis simulate launch_configs/plucked_string.yaml --duration 2s --csv string.csv\n"
      "  cordis lab launch_configs/scenes/plucked_string.yaml --quick\n"
      "  cordis test\n");
}

}  // namespace cordis::cli
