//! Which of several processes this one is, where a launcher (`srun`, `mpirun`) or an array of jobs has started them.
//!
//! Launchers and schedulers tell it by variables. The processes of one launch have a rank, from 0; the jobs of an array have an index. Where
//! each job of an array launches several processes, every process has the share `index * ranks + rank` of all of them. The sources are the
//! manuals of Slurm (sbatch, srun, "Job Array Support"), Open MPI and MPICH (mpirun), LSF, Grid Engine and PBS.

use std::fmt;

use crate::failure::{Failure, refuse};

/// Variables of a launcher: rank of the process and number of processes, and how many of them are on this machine.
struct Launcher {
    name: &'static str,
    rank: &'static str,
    /// The first one that is set.
    count: [&'static str; 2],
    here: [&'static str; 2],
}

/// In this order: what `mpirun` starts in a job of Slurm has the variables of both.
const LAUNCHERS: [Launcher; 3] = [
    Launcher {
        name: "Open MPI",
        rank: "OMPI_COMM_WORLD_RANK",
        count: ["OMPI_COMM_WORLD_SIZE", ""],
        here: ["OMPI_COMM_WORLD_LOCAL_SIZE", ""],
    },
    Launcher { name: "MPICH", rank: "PMI_RANK", count: ["PMI_SIZE", ""], here: ["MPI_LOCALNRANKS", ""] },
    Launcher {
        name: "Slurm",
        rank: "SLURM_PROCID",
        count: [SLURM_STEP, "SLURM_NTASKS"],
        here: ["SLURM_STEP_TASKS_PER_NODE", "SLURM_TASKS_PER_NODE"],
    },
];

/// Set by `srun` alone: the script of a job has `SLURM_PROCID` and `SLURM_NTASKS` too, but is one process.
const SLURM_STEP: &str = "SLURM_STEP_NUM_TASKS";
const SLURM_JOB: &str = "SLURM_JOB_ID";

/// Variables of an array of jobs: index of the job, the first and the last index, the step between them, and the number of jobs.
struct Array {
    name: &'static str,
    index: &'static str,
    first: &'static str,
    last: &'static str,
    step: &'static str,
    count: &'static str,
}

const ARRAYS: [Array; 5] = [
    Array {
        name: "Slurm",
        index: "SLURM_ARRAY_TASK_ID",
        first: "SLURM_ARRAY_TASK_MIN",
        last: "SLURM_ARRAY_TASK_MAX",
        step: "SLURM_ARRAY_TASK_STEP",
        count: "SLURM_ARRAY_TASK_COUNT",
    },
    // Its arrays begin at 1 unless told otherwise, and it does not say so if they are; 0 is no array.
    Array {
        name: "LSF",
        index: "LSB_JOBINDEX",
        first: "",
        last: "LSB_JOBINDEX_END",
        step: "LSB_JOBINDEX_STEP",
        count: "",
    },
    Array {
        name: "Grid Engine",
        index: "SGE_TASK_ID",
        first: "SGE_TASK_FIRST",
        last: "SGE_TASK_LAST",
        step: "SGE_TASK_STEPSIZE",
        count: "",
    },
    Array { name: "PBS", index: "PBS_ARRAY_INDEX", first: "", last: "", step: "", count: "" },
    Array { name: "PBS", index: "PBS_ARRAYID", first: "", last: "", step: "", count: "" },
];

/// The share of one process of several, and who said so.
#[derive(Clone, Debug, PartialEq)]
pub struct Share {
    /// The k-th of n, k from 1.
    pub part: [usize; 2],
    from: String,
}

impl fmt::Display for Share {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [k, n] = self.part;
        write!(f, "share {k}/{n}, as {} says", self.from)
    }
}

/// Reads a variable; those that are not set are `None`.
type Read<'a> = &'a dyn Fn(&str) -> Option<String>;

fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok()
}

/// The share that the option --shard gives, else the one that launcher and scheduler give; `None` for the whole work.
pub fn share(option: Option<[usize; 2]>) -> Option<Share> {
    match option {
        Some(part) => Some(Share { part, from: "--shard".into() }),
        None => told(&variable),
    }
}

/// Refuses what several processes would do alike.
///
/// # Errors
/// With what to do instead, where a launcher has started several.
pub fn refuse_several(what: &str) -> Result<(), Failure> {
    let Some(([_, count], launcher)) = ranks(&variable) else { return Ok(()) };
    let size = launcher.count.into_iter().find(|name| variable(name).is_some()).unwrap_or_default();
    refuse!(
        "`asperity {what}` works with the threads of one process, but {} has started {count} processes of it ({size}={count}). Start one \
         process with more threads (`srun -n 1 -c 16`, `mpirun -n 1`), or take `asperity study`, which divides many cases. If each process \
         has a case of its own, call it as `env -u {size} asperity {what} CASE`",
        launcher.name
    );
}

/// The threads that a process takes of the cores that it may use, `cores` of all `online`.
pub fn threads(cores: usize, online: usize) -> usize {
    threads_by(&variable, cores, online)
}

/// Processes of this launch on this machine, which share its memory.
pub fn neighbours() -> usize {
    neighbours_by(&variable)
}

fn number(read: Read<'_>, name: &str) -> Option<usize> {
    read(name)?.trim().parse().ok()
}

fn told(read: Read<'_>) -> Option<Share> {
    let array = ARRAYS.iter().find_map(|array| Some((array.part(read)?, array.name)));
    let (mut part, mut from) = ([0, 1], vec![]);
    if let Some((of_array, name)) = array {
        (part, from) = (of_array, vec![format!("the array of {name}")]);
    }
    if let Some(([rank, count], launcher)) = ranks(read) {
        part = [part[0] * count + rank, part[1] * count];
        from.push(launcher.name.to_owned());
    }
    (part[1] > 1).then(|| Share { part: [part[0] + 1, part[1]], from: from.join(" and ") })
}

/// Rank and number of the processes of a launch of several.
fn ranks(read: Read<'_>) -> Option<([usize; 2], &'static Launcher)> {
    LAUNCHERS.iter().find_map(|launcher| {
        let rank = number(read, launcher.rank)?;
        let count = launcher.count.into_iter().find_map(|name| number(read, name))?;
        let is_script =
            launcher.count[0] == SLURM_STEP && read(SLURM_STEP).is_none() && read(SLURM_JOB).is_some();
        (count > 1 && rank < count && !is_script).then_some(([rank, count], launcher))
    })
}

impl Array {
    /// Place among the jobs, from 0, and their number; `None` without an array, and where its variables do not tell the place: an array of
    /// PBS, a list of single indices.
    fn part(&self, read: Read<'_>) -> Option<[usize; 2]> {
        let index = number(read, self.index)?;
        let last = number(read, self.last)?;
        let step = number(read, self.step).unwrap_or(1).max(1);
        let count = number(read, self.count);
        let first = match (number(read, self.first), count) {
            (Some(first), _) => first,
            (None, Some(count)) => last.checked_sub(count.saturating_sub(1).checked_mul(step)?)?,
            (None, None) => 1,
        };
        let place = index.checked_sub(first)? / step;
        let jobs = last.checked_sub(first)? / step + 1;
        let is_regular = count.is_none_or(|count| count == jobs) && place < jobs;
        is_regular.then_some([place, jobs])
    }
}

fn threads_by(read: Read<'_>, cores: usize, online: usize) -> usize {
    let few = match number(read, "SLURM_CPUS_PER_TASK") {
        Some(given) => given.min(cores),
        // A process that its launcher has bound sees its own cores; else all processes see those of the machine.
        None if cores == online => cores / neighbours_by(read),
        None => cores,
    };
    few.max(1)
}

fn neighbours_by(read: Read<'_>) -> usize {
    let here = ranks(read).and_then(|(_, launcher)| {
        // Slurm writes "4(x2),3": four on each of two machines, three on the next.
        let text = launcher.here.into_iter().find_map(read)?;
        text.split(',').filter_map(|part| part.split('(').next()?.trim().parse().ok()).max()
    });
    here.unwrap_or(1_usize).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn variables(text: &str) -> impl Fn(&str) -> Option<String> {
        let pairs: Vec<(String, String)> = text
            .split_whitespace()
            .map(|pair| pair.split_once('=').unwrap())
            .map(|(name, value)| (name.to_owned(), value.to_owned()))
            .collect();
        move |name| pairs.iter().find(|(known, _)| known == name).map(|(_, value)| value.clone())
    }

    fn part(text: &str) -> Option<[usize; 2]> {
        told(&variables(text)).map(|share| share.part)
    }

    #[test]
    fn each_launcher_and_array_tells_the_share() {
        for (text, expected) in [
            ("", None),
            ("OMPI_COMM_WORLD_RANK=2 OMPI_COMM_WORLD_SIZE=4", Some([3, 4])),
            ("OMPI_COMM_WORLD_RANK=0 OMPI_COMM_WORLD_SIZE=1", None),
            ("PMI_RANK=0 PMI_SIZE=4", Some([1, 4])),
            ("SLURM_PROCID=15 SLURM_NTASKS=16", Some([16, 16])),
            // srun in a job: the step has fewer tasks than the job.
            ("SLURM_JOB_ID=7 SLURM_PROCID=1 SLURM_NTASKS=16 SLURM_STEP_NUM_TASKS=2", Some([2, 2])),
            // The script of the job itself.
            ("SLURM_JOB_ID=7 SLURM_PROCID=0 SLURM_NTASKS=16", None),
            // mpirun in a job of Slurm.
            (
                "OMPI_COMM_WORLD_RANK=3 OMPI_COMM_WORLD_SIZE=8 SLURM_JOB_ID=7 SLURM_PROCID=0 SLURM_NTASKS=16",
                Some([4, 8]),
            ),
            (
                "SLURM_ARRAY_TASK_ID=5 SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_MAX=9 SLURM_ARRAY_TASK_STEP=2 SLURM_ARRAY_TASK_COUNT=5",
                Some([3, 5]),
            ),
            ("SLURM_ARRAY_TASK_ID=0 SLURM_ARRAY_TASK_MAX=39 SLURM_ARRAY_TASK_COUNT=40", Some([1, 40])),
            // A list of single indices, 1, 3, 20: the place in it is not told.
            (
                "SLURM_ARRAY_TASK_ID=20 SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_MAX=20 SLURM_ARRAY_TASK_COUNT=3",
                None,
            ),
            ("LSB_JOBINDEX=3 LSB_JOBINDEX_END=10", Some([3, 10])),
            ("LSB_JOBINDEX=0 LSB_JOBINDEX_END=0", None),
            ("SGE_TASK_ID=undefined SGE_TASK_FIRST=undefined SGE_TASK_LAST=undefined", None),
            ("SGE_TASK_ID=4 SGE_TASK_FIRST=2 SGE_TASK_LAST=8 SGE_TASK_STEPSIZE=2", Some([2, 4])),
            ("PBS_ARRAY_INDEX=4", None),
            ("OMPI_COMM_WORLD_RANK=9 OMPI_COMM_WORLD_SIZE=4", None),
            ("OMPI_COMM_WORLD_RANK=x OMPI_COMM_WORLD_SIZE=4", None),
        ] {
            assert_eq!(part(text), expected, "{text}");
        }
    }

    #[test]
    fn processes_of_the_jobs_of_an_array_share_all_of_the_work() {
        let mut parts = vec![];
        for job in 1..=3 {
            for rank in 0..4 {
                let text = format!(
                    "SLURM_ARRAY_TASK_ID={job} SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_MAX=3 SLURM_ARRAY_TASK_COUNT=3 \
                     SLURM_JOB_ID=9 SLURM_PROCID={rank} SLURM_STEP_NUM_TASKS=4"
                );
                parts.push(part(&text).unwrap());
            }
        }
        assert_eq!(parts, (1..=12).map(|k| [k, 12]).collect::<Vec<_>>());
    }

    #[test]
    fn threads_are_the_cores_that_a_process_was_given() {
        let threads = |text: &str, cores, online| threads_by(&variables(text), cores, online);
        assert_eq!(threads("", 16, 16), 16);
        assert_eq!(threads("SLURM_CPUS_PER_TASK=4", 16, 16), 4);
        assert_eq!(threads("SLURM_CPUS_PER_TASK=64", 16, 16), 16);
        let four = "OMPI_COMM_WORLD_RANK=0 OMPI_COMM_WORLD_SIZE=4 OMPI_COMM_WORLD_LOCAL_SIZE=4";
        assert_eq!([threads(four, 16, 16), threads(four, 2, 16), threads(four, 2, 2)], [4, 2, 1]);
        let slurm = "SLURM_PROCID=0 SLURM_NTASKS=11 SLURM_TASKS_PER_NODE=4(x2),3";
        assert_eq!([threads(slurm, 16, 16), neighbours_by(&variables(slurm))], [4, 4]);
    }
}
