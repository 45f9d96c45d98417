//! A Slurm of one node on loopback, with its state, keys and ports to itself; it ends with this value.

use std::fs;
use std::io::Read as _;
use std::net::{Ipv4Addr, TcpListener};
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// The daemons, and the Debian packages that have them.
const DAEMONS: [(&str, &str); 4] = [
    ("munged", "munge"),
    ("slurmctld", "slurmctld"),
    ("slurmd", "slurmd"),
    ("sbatch", "slurm-client"),
];

/// Where the daemons are.
pub struct Programs(Vec<PathBuf>);

impl Programs {
    /// Finds them; the error says which packages are missing.
    pub fn find() -> Result<Self, String> {
        let path = std::env::var_os("PATH").unwrap_or_default();
        let folders: Vec<PathBuf> = std::env::split_paths(&path)
            .chain(["/usr/sbin".into(), "/sbin".into()])
            .collect();
        let find = |name: &str| {
            folders
                .iter()
                .map(|folder| folder.join(name))
                .find(|file| file.is_file())
        };
        let missing: Vec<&str> = DAEMONS
            .iter()
            .filter(|(name, _)| find(name).is_none())
            .map(|(_, package)| *package)
            .collect();
        if missing.is_empty() {
            Ok(Self(DAEMONS.iter().filter_map(|(name, _)| find(name)).collect()))
        } else {
            let missing = missing.join(" ");
            Err(format!(
                "Slurm is missing: install the packages {missing} (apt-get install -y --no-install-recommends {missing})"
            ))
        }
    }
}

/// The running daemons.
pub struct Slurm {
    /// The last is stopped first.
    daemons: Vec<Child>,
    conf: PathBuf,
    path: std::ffi::OsString,
}

/// The standard output of a command that must succeed.
pub fn output(command: &mut Command) -> Result<String, String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let failed = |error: &dyn std::fmt::Display| format!("{name}: {error}");
    let done = Command::output(command);
    let done = done.map_err(|error| failed(&error))?;
    if !done.status.success() {
        let text = String::from_utf8_lossy(&done.stderr);
        return Err(failed(&format!("{}: {}", done.status, text.trim())));
    }
    Ok(String::from_utf8_lossy(&done.stdout).into_owned())
}

impl Slurm {
    /// Starts munged, slurmctld and slurmd in a folder. `sweepsim` is on the path of its tasks.
    pub fn start(programs: &Programs, folder: &Path, sweepsim: &Path) -> Result<Self, String> {
        let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
        let state = folder.join("slurm");
        for name in ["ctld", "spool", "munge"] {
            fs::create_dir_all(state.join(name)).map_err(failed)?;
        }
        let mut key = [0; 128];
        fs::File::open("/dev/urandom")
            .and_then(|mut file| file.read_exact(&mut key))
            .map_err(failed)?;
        let key_file = state.join("munge/key");
        fs::write(&key_file, key).map_err(failed)?;
        fs::set_permissions(&key_file, fs::Permissions::from_mode(0o600)).map_err(failed)?;
        let host = output(Command::new("hostname").arg("-s"))?.trim().to_owned();
        let conf = state.join("slurm.conf");
        fs::write(&conf, configuration(&host, &state, free_ports()?)).map_err(failed)?;
        let mut folders: Vec<PathBuf> = sweepsim.parent().map(Path::to_owned).into_iter().collect();
        folders.extend(std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default()));
        let path = std::env::join_paths(folders).map_err(|error| error.to_string())?;
        let mut slurm = Self {
            daemons: Vec::new(),
            conf,
            path,
        };
        let [munged, slurmctld, slurmd, _] = &programs.0[..] else {
            return Err("too few programs".to_owned());
        };
        let munge = |name: &str, file: &str| format!("--{name}={}", state.join("munge").join(file).display());
        let options = [
            "--foreground".to_owned(),
            "--force".to_owned(),
            munge("key-file", "key"),
            munge("socket", "socket"),
            munge("pid-file", "pid"),
            munge("log-file", "log"),
            munge("seed-file", "seed"),
        ];
        slurm.daemon(munged, &options, &state)?;
        let socket = state.join("munge/socket");
        wait("munged", || socket.exists())?;
        slurm.daemon(slurmctld, &["-D".to_owned(), "-i".to_owned()], &state)?;
        slurm.daemon(slurmd, &["-D".to_owned(), "-N".to_owned(), host], &state)?;
        let up = || {
            slurm
                .query(&["sinfo", "-h", "-o", "%T"])
                .is_ok_and(|states| states.trim() == "idle")
        };
        wait("the node", up).map_err(|error| {
            let log = fs::read_to_string(state.join("slurmctld.log")).unwrap_or_default();
            let own = fs::read_to_string(state.join("slurmd.log")).unwrap_or_default();
            format!("{error}\n{log}\n{own}")
        })?;
        Ok(slurm)
    }

    fn daemon(&mut self, program: &Path, options: &[String], state: &Path) -> Result<(), String> {
        let name = program.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let failed = |error: std::io::Error| format!("{name}: {error}");
        let told = fs::File::create(state.join(format!("{name}.out"))).map_err(failed)?;
        let child = self
            .command(program)
            .args(options)
            .stdin(Stdio::null())
            .stdout(told.try_clone().map_err(failed)?)
            .stderr(told)
            .spawn()
            .map_err(failed)?;
        self.daemons.push(child);
        Ok(())
    }

    /// A command that talks to this Slurm.
    pub fn command(&self, program: &Path) -> Command {
        let mut command = Command::new(program);
        command.env("SLURM_CONF", &self.conf).env("PATH", &self.path);
        command
    }

    /// The standard output of one of its commands.
    pub fn query(&self, words: &[&str]) -> Result<String, String> {
        output(self.command(Path::new(words[0])).args(&words[1..]))
    }
}

impl Drop for Slurm {
    fn drop(&mut self) {
        while let Some(mut daemon) = self.daemons.pop() {
            // They are asked to end, so that they leave nothing behind, and made to if they do not.
            let _ = Command::new("kill").arg(daemon.id().to_string()).status();
            let begin = Instant::now();
            while begin.elapsed() < Duration::from_secs(10) && matches!(daemon.try_wait(), Ok(None)) {
                std::thread::sleep(Duration::from_millis(20));
            }
            let _ = daemon.kill();
            let _ = daemon.wait();
        }
    }
}

fn wait(what: &str, done: impl Fn() -> bool) -> Result<(), String> {
    let begin = Instant::now();
    while !done() {
        if begin.elapsed() > Duration::from_secs(30) {
            return Err(format!("{what} is not up after 30 s"));
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    Ok(())
}

fn free_ports() -> Result<[u16; 2], String> {
    let bind =
        || TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).and_then(|socket| Ok((socket.local_addr()?.port(), socket)));
    // Both are open at the same time, so they differ.
    let both = bind().and_then(|first| Ok([first, bind()?]));
    let both = both.map_err(|error| format!("no free port on loopback: {error}"))?;
    Ok(both.map(|(port, _)| port))
}

fn configuration(host: &str, state: &Path, [controller, node]: [u16; 2]) -> String {
    let state = state.display();
    format!(
        "ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={node}
AuthType=auth/munge
AuthInfo=socket={state}/munge/socket,cred_expire=5
SlurmUser=root
StateSaveLocation={state}/ctld
SlurmdSpoolDir={state}/spool
SlurmctldPidFile={state}/slurmctld.pid
SlurmdPidFile={state}/slurmd.pid
SlurmctldLogFile={state}/slurmctld.log
SlurmdLogFile={state}/slurmd.log
MailProg=/bin/true
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SchedulerType=sched/builtin
SchedulerParameters=batch_sched_delay=0,sched_interval=1
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
KillWait=2
NodeName={host} NodeAddr=127.0.0.1 CPUs=2
PartitionName=p Nodes={host} Default=YES
"
    )
}
