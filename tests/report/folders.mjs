// Results folders to make reports of: written by hand, with a curve that is known, and by the program.
import { execFileSync } from "node:child_process";
import { cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

export const kTop = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const kPng = Buffer.from("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==", "base64");

export const temporaryFolder = () => {
  const folder = mkdtempSync(join(tmpdir(), "scree_report_"));
  return { folder, remove: () => rmSync(folder, { recursive: true }) };
};

export const scree = (...args) => execFileSync(process.env.SCREE_COMMAND, args, { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });

// The known curve: nothing until 0.1 s, then 8 g/s at once.
export const kOpen = 0.1, kEnd = 0.5, kRate = 8e-3;
export const discharged = (t) => Math.max(0, t - kOpen) * kRate;
const kRows = 501;

const massFlow = (rate = kRate) => {
  const rows = Array.from({ length: kRows }, (_, k) => (k * kEnd) / (kRows - 1));
  return ["time_s,discharged_kg,mass_flow_kg_per_s", ...rows.map((t) => `${t},${(discharged(t) / kRate) * rate},${t > kOpen ? rate : 0}`)].join("\n") + "\n";
};

const kSummary = {
  title: "known", status: "done", particles: 1000, particles_left: 400, lost_particles: 0, steps: 10000, rebuilds: 10, threads: 2, isa: "avx2",
  time_step_s: 5e-5, physical_time_s: kEnd, wall_time_s: 100, particle_steps_per_second: 1.5e7, peak_rss_bytes: 3e7, state_hash: "0123456789abcdef",
  mass_discharged_kg: discharged(kEnd), mass_retained_kg: 1e-4, steady_mass_flow_kg_per_s: kRate, steady_mass_flow_standard_error_kg_per_s: 2.3e-4,
  steady_window_s: [0.2, 0.4], steady_bins: 8, porosity: null, fibres: 0, wall_seconds: { step: 70, pair_search: 20 }, checkpoints: { written: 1, seconds: 1 },
  stages: [{ name: "settle", kind: "settle", start_s: 0, end_s: kOpen, particles: 1000 }, { name: "drain", kind: "drain", start_s: kOpen, end_s: kEnd, particles: 400 }],
};

// What the observers of fields add to it.
const kFieldNumbers = {
  touch: { looks: 10, window_s: [0.2, 0.4], fibres: { touched_share: 0.62, dead_share: 0.25, out_of_reach_share: 0.05, exposed_area_m2: 2e-4, contacts_per_m2: 1.5e6, mean_normal_force_N: 2.5e-5, upper_half: { touched_share: 0.9, dead_share: 0.02 } }, walls: { channel: { touched_share: 0.5, dead_share: 0.1 } } },
  average_flow: {
    looks: 10, mass_kg: 1e-3, solid_fraction_of_free_space: 0.4, mean_velocity_m_per_s: [0, 0, -0.03], granular_temperature_m2_per_s2: 1e-3,
    junctions: { above: { lines: 6, solid_fraction: 0.2, solid_fraction_of_free_space: 0.5, downward_velocity_m_per_s: 3e-4, speed_over_section_mean: 0.01 }, below: { lines: 6, solid_fraction: 0, downward_velocity_m_per_s: null } },
    lanes: { peak_over_mean: { mean: 2, least: 1.5, most: 2.5 }, distance_from_axis_m: { mean: 2.5e-3, least: 2e-3, most: 3e-3 },
      layers: { z_m: [0, 1e-3, 2e-3], peak_over_mean: [1.5, 2, 2.5], distance_from_axis_m: [2e-3, 3e-3, 2.5e-3] } },
    something_new_kg: 0.25, more_of_it: { low_m: 1, high_m: 2 },
  },
  residence: { entered_kg: 1e-3, went_through_kg: 5e-4, mean_s: 0.15, p10_s: 0.1, median_s: 0.14, p90_s: 0.2, retained_kg: 4e-6, retained_grains: 40, retained_at_no_junction_kg: 0 },
};

// A run's folder as its program leaves it; `changes` to its summary.json, null for none.
export const writeRun = (folder, { title = "A known curve", friction = 0.5, changes = {} } = {}) => {
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, "case.toml"), `title = ${JSON.stringify(title)}\n[[material]]\nname = "glass"\ndensity = 2500\n` +
    `[[particles]]\nname = "bead"\nmaterial = "glass"\ndiameter = 2e-3\n[[pair]]\nmaterials = ["glass", "glass"]\nrestitution = 0.5\nsliding_friction = ${friction}\n`);
  writeFileSync(join(folder, "mass_flow.csv"), massFlow());
  if (changes) writeFileSync(join(folder, "summary.json"), JSON.stringify({ ...kSummary, ...changes }));
  return folder;
};

// Everything that other parts of the program may leave beside it.
export const addPicturesAndFields = (folder) => {
  for (const name of ["pictures/front_speed_0.350000.png", "averages/solid_fraction_x.png", "touch/channel.png", "residence/times.png"]) {
    mkdirSync(dirname(join(folder, name)), { recursive: true });
    writeFileSync(join(folder, name), kPng);
  }
  const file = join(folder, "summary.json");
  writeFileSync(file, JSON.stringify({ ...JSON.parse(readFileSync(file, "utf8")), ...kFieldNumbers }));
  writeFileSync(join(folder, "meters.csv"), "time_s,lattice_kg\n0,0\n0.25,0.002\n0.5,0.001\n");
  writeFileSync(join(folder, "residence.csv"), "from_s,to_s,mass_kg\n0,0.1,1e-4\n0.1,0.2,3e-4\n0.2,0.3,1e-4\n");
  writeFileSync(join(folder, "retained.csv"), "x_m,y_m,z_m,mass_kg,grains\n0,0,0.01,1e-6,10\n0.005,0,0.01,3e-6,30\n0.005,0.005,0.01,0,0\n");
};

// A small silo, run by the program for two seeds and two frictions: the folder of the sweep.
export const runSmallSweep = (folder) => {
  const file = join(folder, "small.toml");
  writeFileSync(file, `title = "Small silo"\ncase = ${JSON.stringify(join(kTop, "cases/examples/orifice_silo.toml"))}\nseeds = [1, 2]\n` +
    `[set]\nstage.fill.mass = 0.3e-3\nstage.settle.time = 0.01\nstage.drain.max_time = 0.03\nstage.drain.discharged_fraction = 1\ntime.rayleigh_fraction = 0.3\noutput.interval = 5e-4\n` +
    `[[parameter]]\nkey = "contact.rolling"\nvalues = ["cdt", "epsd2"]\nlabel = "rolling"\n`);
  scree("sweep", file, "--out", join(folder, "swept"));
  return join(folder, "swept");
};

// The small sweep with known curves in its folders, g/s from 0.1 s on; with a reference of 6.5 g/s and captions.
export const kSweptRates = { rolling_cdt__seed_1: 8, rolling_cdt__seed_2: 6, rolling_epsd2__seed_1: 5, rolling_epsd2__seed_2: 5 };
export const makeKnownSweep = (folder, otherRates = {}) => {
  const out = mkdtempSync(join(folder, "known_")), file = join(folder, "known.toml");
  cpSync(join(folder, "swept"), out, { recursive: true });
  for (const [name, rate] of Object.entries({ ...kSweptRates, ...otherRates })) {
    const run = join(out, name), summary = JSON.parse(readFileSync(join(run, "summary.json"), "utf8"));
    writeFileSync(join(run, "mass_flow.csv"), massFlow(1e-3 * rate));
    writeFileSync(join(run, "summary.json"), JSON.stringify({ ...summary, stages: kSummary.stages, mass_discharged_kg: 1e-3 * rate * (kEnd - kOpen), mass_retained_kg: 1e-4,
      steady_mass_flow_kg_per_s: 1e-3 * rate, steady_mass_flow_standard_error_kg_per_s: 2e-4, steady_window_s: [0.2, 0.4] }));
  }
  writeFileSync(file, `${readFileSync(join(folder, "small.toml"), "utf8")}[reference]\nlabel = "measured"\nvalue = 6.5e-3\nunit = "kg/s"\n` +
    `[captions]\nflow_curves = "as somebody's curves"\nsteady_flow = "as somebody's mass flow against rolling"\n`);
  scree("sweep", file, "--out", out, "--report");
  return out;
};
