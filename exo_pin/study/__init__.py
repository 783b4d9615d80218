"""Studies of many walks on many devices: a plan, run in parallel, its rows kept in a CSV table.

`run(plan(...), "study.csv", jobs=2)` runs a study, or continues it; `jobs` and the back end are joblib's.
"""

from exo_pin.study.case import Case, Outcome, solve
from exo_pin.study.parallel import Study, run
from exo_pin.study.plan import STATURE_RANGE, STATURE_STEP, bodies, plan, recordings, statures
from exo_pin.study.robustness import SimulatedStudy, run_simulations
from exo_pin.study.simulated_plan import simulations
from exo_pin.study.simulated_table import SimulatedRow
from exo_pin.study.study_table import TABLE_COLUMNS, Row, load, save
from exo_pin.study.summary import summary
from exo_pin.study.walking_shares import Share, walking_shares
from exo_pin.study.workers import part

__all__ = [
    "STATURE_RANGE",
    "STATURE_STEP",
    "TABLE_COLUMNS",
    "Case",
    "Outcome",
    "Row",
    "Share",
    "SimulatedRow",
    "SimulatedStudy",
    "Study",
    "bodies",
    "load",
    "part",
    "plan",
    "recordings",
    "run",
    "run_simulations",
    "save",
    "simulations",
    "solve",
    "statures",
    "summary",
    "walking_shares",
]
