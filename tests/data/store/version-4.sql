PRAGMA foreign_keys=OFF;
BEGIN TRANSACTION;
CREATE TABLE meta (
    key   TEXT PRIMARY KEY,
    value TEXT
) STRICT, WITHOUT ROWID;
INSERT INTO meta VALUES('link_rows_limit','16384');
INSERT INTO meta VALUES('rank_rows_limit','256');
INSERT INTO meta VALUES('span_rows_limit','20000');
CREATE TABLE build (
    id       INTEGER PRIMARY KEY,
    version  TEXT NOT NULL,
    git      TEXT NOT NULL,
    compiler TEXT NOT NULL,
    flags    TEXT NOT NULL,
    UNIQUE (version, git, compiler, flags)
) STRICT;
INSERT INTO build VALUES(1,'0.1.0','152ea0f9a27c','gcc 12.2.0','-O2 -g');
CREATE TABLE run (
    id               INTEGER PRIMARY KEY,
    config_hash      TEXT NOT NULL,
    seed             INTEGER NOT NULL,
    rep              INTEGER NOT NULL,
    scenario         TEXT NOT NULL,
    machine          TEXT NOT NULL,
    topology         TEXT NOT NULL,
    level            TEXT NOT NULL,
    placement        TEXT NOT NULL,
    kernel           TEXT NOT NULL,
    formulation      TEXT NOT NULL,
    solver           TEXT NOT NULL,
    part_solver      TEXT NOT NULL,
    operators        TEXT NOT NULL,
    precision        TEXT NOT NULL,
    model            TEXT NOT NULL,
    base             TEXT NOT NULL,
    joint            TEXT NOT NULL,
    n                INTEGER NOT NULL,
    nu               INTEGER NOT NULL,
    P                INTEGER NOT NULL,
    compute_noise_cv REAL,
    background_load  REAL,
    status           TEXT NOT NULL CHECK (status IN ('ok', 'invalid', 'deadlock', 'failed')),
    text             TEXT NOT NULL,
    makespan_ps      INTEGER NOT NULL,
    measured_s       REAL,
    loop_rows        INTEGER,
    loop_rank        INTEGER,
    drift_position   REAL,
    drift_velocity   REAL,
    residual         REAL,
    condition        REAL,
    messages         INTEGER NOT NULL,
    sent_bytes       INTEGER NOT NULL,
    events           INTEGER NOT NULL,
    ties             INTEGER NOT NULL,
    switches         INTEGER NOT NULL,
    digest           TEXT NOT NULL,
    accounting_error_ps INTEGER NOT NULL,
    finish_min_ps    INTEGER,
    finish_max_ps    INTEGER,
    rank_compute_min_ps INTEGER,
    rank_compute_max_ps INTEGER,
    links            INTEGER NOT NULL,
    host_s           REAL,
    host_total_s     REAL,
    host_peak_bytes  INTEGER,
    stack_peak_bytes INTEGER,
    level_asked      TEXT,
    level_error      REAL,
    level_error_at   TEXT,
    inner_added      INTEGER NOT NULL,
    outer_added      INTEGER NOT NULL,
    twice_added      INTEGER NOT NULL,
    residual_before  REAL,
    left_out         TEXT NOT NULL,
    config_text      TEXT NOT NULL,
    build_id         INTEGER NOT NULL REFERENCES build (id),
    created_utc      TEXT NOT NULL,
    UNIQUE (config_hash, seed, rep)
) STRICT;
INSERT INTO run VALUES(1,'f4e875e3882bc4511fb3b789d3f939c02ae525e100c6778ec50bc6b81e2c287c',1,0,'small','t3e-300','torus','link','linear','dynamics','paper','pcr-symmetric','pcr','structured','double','serial-chain','fixed','revolute',2,2,2,0.0,0.0,'ok','',244015762,NULL,NULL,NULL,NULL,NULL,4.6810875464771036051e-12,125.78295476027810196,17,1112,34,2,20,'42c369d40f061949',0,233862806,244015762,29930304,31771211,0,9.6143000519077759236e-05,0.00038375199983420316129,3690496,4096,NULL,NULL,NULL,0,0,0,NULL,'external forces: no body has any; angular base terms: the base does not turn; scene and serial answers of other runs: runs of one scene share them; branch and loop phases: an open chain has neither; general joints in the serial references: all joints are revolute; events that start messages: eager sends are in order; timeline: record.spans does not ask for it; counters of single links: record.links does not ask for them',replace('scenario = small\nranks = 2\nseed = 1\nrecord.baselines = all\nrecord.links = false\nrecord.spans = false\nmachine.name = t3e-300\nmachine.topology.family = torus\nmachine.topology.dims = [8, 4, 4]\nmachine.topology.dim_bandwidth = [0 B/s]\nmachine.topology.nodes_per_router = 1\nmachine.topology.processors_per_node = 1\nmachine.topology.tie = positive\nmachine.topology.routing = minimal\nmachine.topology.xpress = false\nmachine.topology.links = []\nmachine.topology.link_percent = []\nmachine.node.flop_rate = 55 Mflop/s\nmachine.node.clock = 300 MHz\nmachine.node.div = 23 cycles\nmachine.node.sqrt = 85 cycles\nmachine.node.trig = 150 cycles\nmachine.node.call = 50 ns\nmachine.node.copy.bandwidth = 600 MB/s\nmachine.network.level = link\nmachine.network.tolerance = 2 %\nmachine.network.link.bandwidth = 480 MB/s\nmachine.network.injection.bandwidth = 340 MB/s\nmachine.network.ejection.bandwidth = 480 MB/s\nmachine.network.hop_latency = 60 ns\nmachine.network.end_latency = 2.88 us\nmachine.network.credit_latency = 27 ns\nmachine.network.flit = 8 B\nmachine.network.packet = 64 B\nmachine.network.header = 0 B\nmachine.network.virtual_channels = 2\nmachine.network.buffer = 22\nmachine.network.arbitration = round-robin\nmachine.software.send.overhead = 6 us\nmachine.software.send.copy = 1.471 ns/B\nmachine.software.recv.overhead = 7 us\nmachine.software.recv.copy = 1.471 ns/B\nmachine.software.gap = 8 us\nmachine.software.gap_per_byte = 0 s/B\nmachine.software.short.limit = 0 B\nmachine.software.short.saving = 0 s\nmachine.software.short.copy = 0 s/B\nmachine.software.eager.limit = 4 KiB\nmachine.software.eager.copy = 0 s/B\nmachine.software.rendezvous.latency = 0 s\nmachine.software.kernel.server = false\nmachine.software.kernel.time = 0 s\nmachine.software.kernel.per_byte = 0 s/B\nmachine.software.barrier.kind = hardware\nmachine.software.barrier.time = 8 us\nmachine.software.shared.latency = 0 s\nmachine.software.shared.bandwidth = 0 B/s\nmachine.placement.kind = linear\nmachine.placement.spread = block\nmachine.placement.seed = 1\nmachine.placement.list = []\nmachine.noise.compute = 0 %\nmachine.noise.background.load = 0 %\nmachine.noise.background.message = 1 KiB\nmodel.generator = serial-chain\nmodel.n = 2\nmodel.joint = revolute\nmodel.base = fixed\nmodel.inertia = uniform\nmodel.pose = random\nmodel.axes = twisted\nmodel.length = 1 m\nmodel.radius = 50 mm\nmodel.mass = 1 kg\nmodel.mass_ratio = 1\nmodel.gravity = [0 m/s^2, 0 m/s^2, -9.81 m/s^2]\nmodel.base_acceleration.angular = [0 rad/s^2, 0 rad/s^2, 0 rad/s^2]\nmodel.base_acceleration.linear = [0 m/s^2, 0 m/s^2, 0 m/s^2]\nmodel.rate = 1 rad/s\nmodel.torque = 1 N m\nmodel.external_force = 0 N\nmodel.stiffness = 0 N m/rad\nmodel.damping = 0 N m s/rad\nmodel.stabilisation = 0 rad/s\nmodel.branch = 2\nmodel.seed = 1\nmodel.path = \nkernel.name = dynamics\nkernel.formulation = paper\nkernel.solver = pcr-symmetric\nkernel.part_solver = pcr\nkernel.operators = structured\nkernel.algebra = auto\nkernel.precision = double\nkernel.partition = block\nkernel.composites_incoming = false\nkernel.hybrid_levels = 1\nkernel.refinement = as-needed\nkernel.residual = working\nkernel.inner_refinements = 0\nkernel.outer_refinements = 0\nkernel.steps = 0\nkernel.step_size = 1 ms\nkernel.step = semi-implicit\nkernel.repeat = 1\nkernel.message = 0 B\nkernel.distance = 1\n','\n',char(10)),1,'2026-11-22T11:27:36Z');
INSERT INTO run VALUES(2,'0ab479fb6ff875e2548660e50fbe3f94524bc9400331b6b086b03a1d54b03b3d',1,0,'small','t3e-300','torus','link','linear','dynamics','paper','pcr-symmetric','pcr','structured','double','serial-chain','fixed','revolute',4,4,4,0.0,0.0,'ok','',434997430,NULL,NULL,NULL,NULL,NULL,3.2243917056690799939e-11,362.31487477527178952,71,5736,158,22,77,'0e748f06cb850db0',0,424535383,434997430,38272728,67095452,0,0.00016492600025230785831,0.00055759199949534377083,3690496,4096,NULL,NULL,NULL,0,0,0,NULL,'external forces: no body has any; angular base terms: the base does not turn; scene and serial answers of other runs: runs of one scene share them; branch and loop phases: an open chain has neither; general joints in the serial references: all joints are revolute; events that start messages: eager sends are in order; timeline: record.spans does not ask for it; counters of single links: record.links does not ask for them',replace('scenario = small\nranks = 4\nseed = 1\nrecord.baselines = all\nrecord.links = false\nrecord.spans = false\nmachine.name = t3e-300\nmachine.topology.family = torus\nmachine.topology.dims = [8, 4, 4]\nmachine.topology.dim_bandwidth = [0 B/s]\nmachine.topology.nodes_per_router = 1\nmachine.topology.processors_per_node = 1\nmachine.topology.tie = positive\nmachine.topology.routing = minimal\nmachine.topology.xpress = false\nmachine.topology.links = []\nmachine.topology.link_percent = []\nmachine.node.flop_rate = 55 Mflop/s\nmachine.node.clock = 300 MHz\nmachine.node.div = 23 cycles\nmachine.node.sqrt = 85 cycles\nmachine.node.trig = 150 cycles\nmachine.node.call = 50 ns\nmachine.node.copy.bandwidth = 600 MB/s\nmachine.network.level = link\nmachine.network.tolerance = 2 %\nmachine.network.link.bandwidth = 480 MB/s\nmachine.network.injection.bandwidth = 340 MB/s\nmachine.network.ejection.bandwidth = 480 MB/s\nmachine.network.hop_latency = 60 ns\nmachine.network.end_latency = 2.88 us\nmachine.network.credit_latency = 27 ns\nmachine.network.flit = 8 B\nmachine.network.packet = 64 B\nmachine.network.header = 0 B\nmachine.network.virtual_channels = 2\nmachine.network.buffer = 22\nmachine.network.arbitration = round-robin\nmachine.software.send.overhead = 6 us\nmachine.software.send.copy = 1.471 ns/B\nmachine.software.recv.overhead = 7 us\nmachine.software.recv.copy = 1.471 ns/B\nmachine.software.gap = 8 us\nmachine.software.gap_per_byte = 0 s/B\nmachine.software.short.limit = 0 B\nmachine.software.short.saving = 0 s\nmachine.software.short.copy = 0 s/B\nmachine.software.eager.limit = 4 KiB\nmachine.software.eager.copy = 0 s/B\nmachine.software.rendezvous.latency = 0 s\nmachine.software.kernel.server = false\nmachine.software.kernel.time = 0 s\nmachine.software.kernel.per_byte = 0 s/B\nmachine.software.barrier.kind = hardware\nmachine.software.barrier.time = 8 us\nmachine.software.shared.latency = 0 s\nmachine.software.shared.bandwidth = 0 B/s\nmachine.placement.kind = linear\nmachine.placement.spread = block\nmachine.placement.seed = 1\nmachine.placement.list = []\nmachine.noise.compute = 0 %\nmachine.noise.background.load = 0 %\nmachine.noise.background.message = 1 KiB\nmodel.generator = serial-chain\nmodel.n = 4\nmodel.joint = revolute\nmodel.base = fixed\nmodel.inertia = uniform\nmodel.pose = random\nmodel.axes = twisted\nmodel.length = 1 m\nmodel.radius = 50 mm\nmodel.mass = 1 kg\nmodel.mass_ratio = 1\nmodel.gravity = [0 m/s^2, 0 m/s^2, -9.81 m/s^2]\nmodel.base_acceleration.angular = [0 rad/s^2, 0 rad/s^2, 0 rad/s^2]\nmodel.base_acceleration.linear = [0 m/s^2, 0 m/s^2, 0 m/s^2]\nmodel.rate = 1 rad/s\nmodel.torque = 1 N m\nmodel.external_force = 0 N\nmodel.stiffness = 0 N m/rad\nmodel.damping = 0 N m s/rad\nmodel.stabilisation = 0 rad/s\nmodel.branch = 2\nmodel.seed = 1\nmodel.path = \nkernel.name = dynamics\nkernel.formulation = paper\nkernel.solver = pcr-symmetric\nkernel.part_solver = pcr\nkernel.operators = structured\nkernel.algebra = auto\nkernel.precision = double\nkernel.partition = block\nkernel.composites_incoming = false\nkernel.hybrid_levels = 1\nkernel.refinement = as-needed\nkernel.residual = working\nkernel.inner_refinements = 0\nkernel.outer_refinements = 0\nkernel.steps = 0\nkernel.step_size = 1 ms\nkernel.step = semi-implicit\nkernel.repeat = 1\nkernel.message = 0 B\nkernel.distance = 1\n','\n',char(10)),1,'2026-11-22T11:27:36Z');
INSERT INTO run VALUES(3,'03eca4c6522516f2e2c772dcbca9d0bb221ca2f06036b8a384dca9e9c33b4454',1,0,'small','t3e-300','torus','loggp','linear','dynamics','paper','pcr-symmetric','pcr','structured','double','serial-chain','fixed','revolute',2,2,2,0.0,0.0,'ok','',244015762,NULL,NULL,NULL,NULL,NULL,4.6810875464771036051e-12,125.78295476027810196,17,1112,0,0,13,'80ae398114bb1807',0,233862806,244015762,29930304,31771211,0,5.3689999731432180851e-05,0.00023102500017557758837,3690496,4096,NULL,NULL,NULL,0,0,0,NULL,'external forces: no body has any; angular base terms: the base does not turn; scene and serial answers of other runs: runs of one scene share them; branch and loop phases: an open chain has neither; general joints in the serial references: all joints are revolute; timeline: record.spans does not ask for it; counters of single links: record.links does not ask for them',replace('scenario = small\nranks = 2\nseed = 1\nrecord.baselines = all\nrecord.links = false\nrecord.spans = false\nmachine.name = t3e-300\nmachine.topology.family = torus\nmachine.topology.dims = [8, 4, 4]\nmachine.topology.dim_bandwidth = [0 B/s]\nmachine.topology.nodes_per_router = 1\nmachine.topology.processors_per_node = 1\nmachine.topology.tie = positive\nmachine.topology.routing = minimal\nmachine.topology.xpress = false\nmachine.topology.links = []\nmachine.topology.link_percent = []\nmachine.node.flop_rate = 55 Mflop/s\nmachine.node.clock = 300 MHz\nmachine.node.div = 23 cycles\nmachine.node.sqrt = 85 cycles\nmachine.node.trig = 150 cycles\nmachine.node.call = 50 ns\nmachine.node.copy.bandwidth = 600 MB/s\nmachine.network.level = loggp\nmachine.network.tolerance = 2 %\nmachine.network.link.bandwidth = 480 MB/s\nmachine.network.injection.bandwidth = 340 MB/s\nmachine.network.ejection.bandwidth = 480 MB/s\nmachine.network.hop_latency = 60 ns\nmachine.network.end_latency = 2.88 us\nmachine.network.credit_latency = 27 ns\nmachine.network.flit = 8 B\nmachine.network.packet = 64 B\nmachine.network.header = 0 B\nmachine.network.virtual_channels = 2\nmachine.network.buffer = 22\nmachine.network.arbitration = round-robin\nmachine.software.send.overhead = 6 us\nmachine.software.send.copy = 1.471 ns/B\nmachine.software.recv.overhead = 7 us\nmachine.software.recv.copy = 1.471 ns/B\nmachine.software.gap = 8 us\nmachine.software.gap_per_byte = 0 s/B\nmachine.software.short.limit = 0 B\nmachine.software.short.saving = 0 s\nmachine.software.short.copy = 0 s/B\nmachine.software.eager.limit = 4 KiB\nmachine.software.eager.copy = 0 s/B\nmachine.software.rendezvous.latency = 0 s\nmachine.software.kernel.server = false\nmachine.software.kernel.time = 0 s\nmachine.software.kernel.per_byte = 0 s/B\nmachine.software.barrier.kind = hardware\nmachine.software.barrier.time = 8 us\nmachine.software.shared.latency = 0 s\nmachine.software.shared.bandwidth = 0 B/s\nmachine.placement.kind = linear\nmachine.placement.spread = block\nmachine.placement.seed = 1\nmachine.placement.list = []\nmachine.noise.compute = 0 %\nmachine.noise.background.load = 0 %\nmachine.noise.background.message = 1 KiB\nmodel.generator = serial-chain\nmodel.n = 2\nmodel.joint = revolute\nmodel.base = fixed\nmodel.inertia = uniform\nmodel.pose = random\nmodel.axes = twisted\nmodel.length = 1 m\nmodel.radius = 50 mm\nmodel.mass = 1 kg\nmodel.mass_ratio = 1\nmodel.gravity = [0 m/s^2, 0 m/s^2, -9.81 m/s^2]\nmodel.base_acceleration.angular = [0 rad/s^2, 0 rad/s^2, 0 rad/s^2]\nmodel.base_acceleration.linear = [0 m/s^2, 0 m/s^2, 0 m/s^2]\nmodel.rate = 1 rad/s\nmodel.torque = 1 N m\nmodel.external_force = 0 N\nmodel.stiffness = 0 N m/rad\nmodel.damping = 0 N m s/rad\nmodel.stabilisation = 0 rad/s\nmodel.branch = 2\nmodel.seed = 1\nmodel.path = \nkernel.name = dynamics\nkernel.formulation = paper\nkernel.solver = pcr-symmetric\nkernel.part_solver = pcr\nkernel.operators = structured\nkernel.algebra = auto\nkernel.precision = double\nkernel.partition = block\nkernel.composites_incoming = false\nkernel.hybrid_levels = 1\nkernel.refinement = as-needed\nkernel.residual = working\nkernel.inner_refinements = 0\nkernel.outer_refinements = 0\nkernel.steps = 0\nkernel.step_size = 1 ms\nkernel.step = semi-implicit\nkernel.repeat = 1\nkernel.message = 0 B\nkernel.distance = 1\n','\n',char(10)),1,'2026-11-22T11:27:36Z');
INSERT INTO run VALUES(4,'efbff34692dba0ef44924e0f0a15a7b608fcd12fd30b6037f5e42b6856febe4c',1,0,'small','t3e-300','torus','loggp','linear','dynamics','paper','pcr-symmetric','pcr','structured','double','serial-chain','fixed','revolute',4,4,4,0.0,0.0,'ok','',434997430,NULL,NULL,NULL,NULL,NULL,3.2243917056690799939e-11,362.31487477527178952,71,5736,0,0,46,'bae6b12e4f7f9e2d',0,424535383,434997430,38272728,67095452,0,8.485599937557708472e-05,0.00026651799998944625258,3690496,4096,NULL,NULL,NULL,0,0,0,NULL,'external forces: no body has any; angular base terms: the base does not turn; scene and serial answers of other runs: runs of one scene share them; branch and loop phases: an open chain has neither; general joints in the serial references: all joints are revolute; timeline: record.spans does not ask for it; counters of single links: record.links does not ask for them',replace('scenario = small\nranks = 4\nseed = 1\nrecord.baselines = all\nrecord.links = false\nrecord.spans = false\nmachine.name = t3e-300\nmachine.topology.family = torus\nmachine.topology.dims = [8, 4, 4]\nmachine.topology.dim_bandwidth = [0 B/s]\nmachine.topology.nodes_per_router = 1\nmachine.topology.processors_per_node = 1\nmachine.topology.tie = positive\nmachine.topology.routing = minimal\nmachine.topology.xpress = false\nmachine.topology.links = []\nmachine.topology.link_percent = []\nmachine.node.flop_rate = 55 Mflop/s\nmachine.node.clock = 300 MHz\nmachine.node.div = 23 cycles\nmachine.node.sqrt = 85 cycles\nmachine.node.trig = 150 cycles\nmachine.node.call = 50 ns\nmachine.node.copy.bandwidth = 600 MB/s\nmachine.network.level = loggp\nmachine.network.tolerance = 2 %\nmachine.network.link.bandwidth = 480 MB/s\nmachine.network.injection.bandwidth = 340 MB/s\nmachine.network.ejection.bandwidth = 480 MB/s\nmachine.network.hop_latency = 60 ns\nmachine.network.end_latency = 2.88 us\nmachine.network.credit_latency = 27 ns\nmachine.network.flit = 8 B\nmachine.network.packet = 64 B\nmachine.network.header = 0 B\nmachine.network.virtual_channels = 2\nmachine.network.buffer = 22\nmachine.network.arbitration = round-robin\nmachine.software.send.overhead = 6 us\nmachine.software.send.copy = 1.471 ns/B\nmachine.software.recv.overhead = 7 us\nmachine.software.recv.copy = 1.471 ns/B\nmachine.software.gap = 8 us\nmachine.software.gap_per_byte = 0 s/B\nmachine.software.short.limit = 0 B\nmachine.software.short.saving = 0 s\nmachine.software.short.copy = 0 s/B\nmachine.software.eager.limit = 4 KiB\nmachine.software.eager.copy = 0 s/B\nmachine.software.rendezvous.latency = 0 s\nmachine.software.kernel.server = false\nmachine.software.kernel.time = 0 s\nmachine.software.kernel.per_byte = 0 s/B\nmachine.software.barrier.kind = hardware\nmachine.software.barrier.time = 8 us\nmachine.software.shared.latency = 0 s\nmachine.software.shared.bandwidth = 0 B/s\nmachine.placement.kind = linear\nmachine.placement.spread = block\nmachine.placement.seed = 1\nmachine.placement.list = []\nmachine.noise.compute = 0 %\nmachine.noise.background.load = 0 %\nmachine.noise.background.message = 1 KiB\nmodel.generator = serial-chain\nmodel.n = 4\nmodel.joint = revolute\nmodel.base = fixed\nmodel.inertia = uniform\nmodel.pose = random\nmodel.axes = twisted\nmodel.length = 1 m\nmodel.radius = 50 mm\nmodel.mass = 1 kg\nmodel.mass_ratio = 1\nmodel.gravity = [0 m/s^2, 0 m/s^2, -9.81 m/s^2]\nmodel.base_acceleration.angular = [0 rad/s^2, 0 rad/s^2, 0 rad/s^2]\nmodel.base_acceleration.linear = [0 m/s^2, 0 m/s^2, 0 m/s^2]\nmodel.rate = 1 rad/s\nmodel.torque = 1 N m\nmodel.external_force = 0 N\nmodel.stiffness = 0 N m/rad\nmodel.damping = 0 N m s/rad\nmodel.stabilisation = 0 rad/s\nmodel.branch = 2\nmodel.seed = 1\nmodel.path = \nkernel.name = dynamics\nkernel.formulation = paper\nkernel.solver = pcr-symmetric\nkernel.part_solver = pcr\nkernel.operators = structured\nkernel.algebra = auto\nkernel.precision = double\nkernel.partition = block\nkernel.composites_incoming = false\nkernel.hybrid_levels = 1\nkernel.refinement = as-needed\nkernel.residual = working\nkernel.inner_refinements = 0\nkernel.outer_refinements = 0\nkernel.steps = 0\nkernel.step_size = 1 ms\nkernel.step = semi-implicit\nkernel.repeat = 1\nkernel.message = 0 B\nkernel.distance = 1\n','\n',char(10)),1,'2026-11-22T11:27:36Z');
INSERT INTO run VALUES(5,'34c1fd8d2b1918906c19a6e3e517d73dc229c029f8f1d36dd9baeafb2176eb08',1,0,'small','t3e-300','torus','loggp','linear','dynamics','paper','pcr-symmetric','pcr','structured','double','serial-chain','fixed','revolute',3,3,3,0.0,0.0,'ok','',392352995,NULL,NULL,NULL,NULL,NULL,3.6570768836111345724e-11,335.71590182755289789,44,3424,0,0,28,'1743f305f277c979',0,376554134,392352995,38272728,53545454,0,0.00010921299963229103013,0.00035816399940813425928,5324800,4096,'auto-tolerance 3 %',0.0,'n=P=3',0,0,0,NULL,'external forces: no body has any; angular base terms: the base does not turn; scene and serial answers of other runs: runs of one scene share them; branch and loop phases: an open chain has neither; general joints in the serial references: all joints are revolute; timeline: record.spans does not ask for it; counters of single links: record.links does not ask for them',replace('scenario = small\nranks = 3\nseed = 1\nrecord.baselines = all\nrecord.links = false\nrecord.spans = false\nmachine.name = t3e-300\nmachine.topology.family = torus\nmachine.topology.dims = [8, 4, 4]\nmachine.topology.dim_bandwidth = [0 B/s]\nmachine.topology.nodes_per_router = 1\nmachine.topology.processors_per_node = 1\nmachine.topology.tie = positive\nmachine.topology.routing = minimal\nmachine.topology.xpress = false\nmachine.topology.links = []\nmachine.topology.link_percent = []\nmachine.node.flop_rate = 55 Mflop/s\nmachine.node.clock = 300 MHz\nmachine.node.div = 23 cycles\nmachine.node.sqrt = 85 cycles\nmachine.node.trig = 150 cycles\nmachine.node.call = 50 ns\nmachine.node.copy.bandwidth = 600 MB/s\nmachine.network.level = auto-tolerance\nmachine.network.tolerance = 3 %\nmachine.network.link.bandwidth = 480 MB/s\nmachine.network.injection.bandwidth = 340 MB/s\nmachine.network.ejection.bandwidth = 480 MB/s\nmachine.network.hop_latency = 60 ns\nmachine.network.end_latency = 2.88 us\nmachine.network.credit_latency = 27 ns\nmachine.network.flit = 8 B\nmachine.network.packet = 64 B\nmachine.network.header = 0 B\nmachine.network.virtual_channels = 2\nmachine.network.buffer = 22\nmachine.network.arbitration = round-robin\nmachine.software.send.overhead = 6 us\nmachine.software.send.copy = 1.471 ns/B\nmachine.software.recv.overhead = 7 us\nmachine.software.recv.copy = 1.471 ns/B\nmachine.software.gap = 8 us\nmachine.software.gap_per_byte = 0 s/B\nmachine.software.short.limit = 0 B\nmachine.software.short.saving = 0 s\nmachine.software.short.copy = 0 s/B\nmachine.software.eager.limit = 4 KiB\nmachine.software.eager.copy = 0 s/B\nmachine.software.rendezvous.latency = 0 s\nmachine.software.kernel.server = false\nmachine.software.kernel.time = 0 s\nmachine.software.kernel.per_byte = 0 s/B\nmachine.software.barrier.kind = hardware\nmachine.software.barrier.time = 8 us\nmachine.software.shared.latency = 0 s\nmachine.software.shared.bandwidth = 0 B/s\nmachine.placement.kind = linear\nmachine.placement.spread = block\nmachine.placement.seed = 1\nmachine.placement.list = []\nmachine.noise.compute = 0 %\nmachine.noise.background.load = 0 %\nmachine.noise.background.message = 1 KiB\nmodel.generator = serial-chain\nmodel.n = 3\nmodel.joint = revolute\nmodel.base = fixed\nmodel.inertia = uniform\nmodel.pose = random\nmodel.axes = twisted\nmodel.length = 1 m\nmodel.radius = 50 mm\nmodel.mass = 1 kg\nmodel.mass_ratio = 1\nmodel.gravity = [0 m/s^2, 0 m/s^2, -9.81 m/s^2]\nmodel.base_acceleration.angular = [0 rad/s^2, 0 rad/s^2, 0 rad/s^2]\nmodel.base_acceleration.linear = [0 m/s^2, 0 m/s^2, 0 m/s^2]\nmodel.rate = 1 rad/s\nmodel.torque = 1 N m\nmodel.external_force = 0 N\nmodel.stiffness = 0 N m/rad\nmodel.damping = 0 N m s/rad\nmodel.stabilisation = 0 rad/s\nmodel.branch = 2\nmodel.seed = 1\nmodel.path = \nkernel.name = dynamics\nkernel.formulation = paper\nkernel.solver = pcr-symmetric\nkernel.part_solver = pcr\nkernel.operators = structured\nkernel.algebra = auto\nkernel.precision = double\nkernel.partition = block\nkernel.composites_incoming = false\nkernel.hybrid_levels = 1\nkernel.refinement = as-needed\nkernel.residual = working\nkernel.inner_refinements = 0\nkernel.outer_refinements = 0\nkernel.steps = 0\nkernel.step_size = 1 ms\nkernel.step = semi-implicit\nkernel.repeat = 1\nkernel.message = 0 B\nkernel.distance = 1\n','\n',char(10)),1,'2026-11-22T11:27:36Z');
INSERT INTO run VALUES(6,'3680c4879557341b483459aa852a9600f6210052b4043387948f91dd495772ba',9,0,'small','t3e-300','torus','link','linear','dynamics','paper','pcr-symmetric','pcr','structured','double','serial-chain','fixed','revolute',2,2,2,0.050000000000000002775,0.0,'ok','',243203259,NULL,NULL,NULL,NULL,NULL,4.6810875464771036051e-12,125.78295476027810196,17,1112,34,0,20,'37eb15851a82bacd',0,233071520,243203259,30116571,30709664,0,0.00010410600043542217463,0.00041637199956312542781,4964352,4096,NULL,NULL,NULL,0,0,0,NULL,'external forces: no body has any; angular base terms: the base does not turn; scene and serial answers of other runs: runs of one scene share them; branch and loop phases: an open chain has neither; general joints in the serial references: all joints are revolute; events that start messages: eager sends are in order; timeline: record.spans does not ask for it; counters of single links: record.links does not ask for them',replace('scenario = small\nranks = 2\nseed = 9\nrecord.baselines = all\nrecord.links = false\nrecord.spans = false\nmachine.name = t3e-300\nmachine.topology.family = torus\nmachine.topology.dims = [8, 4, 4]\nmachine.topology.dim_bandwidth = [0 B/s]\nmachine.topology.nodes_per_router = 1\nmachine.topology.processors_per_node = 1\nmachine.topology.tie = positive\nmachine.topology.routing = minimal\nmachine.topology.xpress = false\nmachine.topology.links = []\nmachine.topology.link_percent = []\nmachine.node.flop_rate = 55 Mflop/s\nmachine.node.clock = 300 MHz\nmachine.node.div = 23 cycles\nmachine.node.sqrt = 85 cycles\nmachine.node.trig = 150 cycles\nmachine.node.call = 50 ns\nmachine.node.copy.bandwidth = 600 MB/s\nmachine.network.level = link\nmachine.network.tolerance = 2 %\nmachine.network.link.bandwidth = 480 MB/s\nmachine.network.injection.bandwidth = 340 MB/s\nmachine.network.ejection.bandwidth = 480 MB/s\nmachine.network.hop_latency = 60 ns\nmachine.network.end_latency = 2.88 us\nmachine.network.credit_latency = 27 ns\nmachine.network.flit = 8 B\nmachine.network.packet = 64 B\nmachine.network.header = 0 B\nmachine.network.virtual_channels = 2\nmachine.network.buffer = 22\nmachine.network.arbitration = round-robin\nmachine.software.send.overhead = 6 us\nmachine.software.send.copy = 1.471 ns/B\nmachine.software.recv.overhead = 7 us\nmachine.software.recv.copy = 1.471 ns/B\nmachine.software.gap = 8 us\nmachine.software.gap_per_byte = 0 s/B\nmachine.software.short.limit = 0 B\nmachine.software.short.saving = 0 s\nmachine.software.short.copy = 0 s/B\nmachine.software.eager.limit = 4 KiB\nmachine.software.eager.copy = 0 s/B\nmachine.software.rendezvous.latency = 0 s\nmachine.software.kernel.server = false\nmachine.software.kernel.time = 0 s\nmachine.software.kernel.per_byte = 0 s/B\nmachine.software.barrier.kind = hardware\nmachine.software.barrier.time = 8 us\nmachine.software.shared.latency = 0 s\nmachine.software.shared.bandwidth = 0 B/s\nmachine.placement.kind = linear\nmachine.placement.spread = block\nmachine.placement.seed = 1\nmachine.placement.list = []\nmachine.noise.compute = 5 %\nmachine.noise.background.load = 0 %\nmachine.noise.background.message = 1 KiB\nmodel.generator = serial-chain\nmodel.n = 2\nmodel.joint = revolute\nmodel.base = fixed\nmodel.inertia = uniform\nmodel.pose = random\nmodel.axes = twisted\nmodel.length = 1 m\nmodel.radius = 50 mm\nmodel.mass = 1 kg\nmodel.mass_ratio = 1\nmodel.gravity = [0 m/s^2, 0 m/s^2, -9.81 m/s^2]\nmodel.base_acceleration.angular = [0 rad/s^2, 0 rad/s^2, 0 rad/s^2]\nmodel.base_acceleration.linear = [0 m/s^2, 0 m/s^2, 0 m/s^2]\nmodel.rate = 1 rad/s\nmodel.torque = 1 N m\nmodel.external_force = 0 N\nmodel.stiffness = 0 N m/rad\nmodel.damping = 0 N m s/rad\nmodel.stabilisation = 0 rad/s\nmodel.branch = 2\nmodel.seed = 1\nmodel.path = \nkernel.name = dynamics\nkernel.formulation = paper\nkernel.solver = pcr-symmetric\nkernel.part_solver = pcr\nkernel.operators = structured\nkernel.algebra = auto\nkernel.precision = double\nkernel.partition = block\nkernel.composites_incoming = false\nkernel.hybrid_levels = 1\nkernel.refinement = as-needed\nkernel.residual = working\nkernel.inner_refinements = 0\nkernel.outer_refinements = 0\nkernel.steps = 0\nkernel.step_size = 1 ms\nkernel.step = semi-implicit\nkernel.repeat = 1\nkernel.message = 0 B\nkernel.distance = 1\n','\n',char(10)),1,'2026-11-22T11:35:30Z');
CREATE TABLE setting (
    id    INTEGER PRIMARY KEY,
    key   TEXT NOT NULL,
    value TEXT NOT NULL,
    UNIQUE (key, value)
) STRICT;
INSERT INTO setting VALUES(1,'scenario','small');
INSERT INTO setting VALUES(2,'ranks','2');
INSERT INTO setting VALUES(3,'seed','1');
INSERT INTO setting VALUES(4,'record.baselines','all');
INSERT INTO setting VALUES(5,'record.links','false');
INSERT INTO setting VALUES(6,'record.spans','false');
INSERT INTO setting VALUES(7,'machine.name','t3e-300');
INSERT INTO setting VALUES(8,'machine.topology.family','torus');
INSERT INTO setting VALUES(9,'machine.topology.dims','[8, 4, 4]');
INSERT INTO setting VALUES(10,'machine.topology.dim_bandwidth','[0 B/s]');
INSERT INTO setting VALUES(11,'machine.topology.nodes_per_router','1');
INSERT INTO setting VALUES(12,'machine.topology.processors_per_node','1');
INSERT INTO setting VALUES(13,'machine.topology.tie','positive');
INSERT INTO setting VALUES(14,'machine.topology.routing','minimal');
INSERT INTO setting VALUES(15,'machine.topology.xpress','false');
INSERT INTO setting VALUES(16,'machine.topology.links','[]');
INSERT INTO setting VALUES(17,'machine.topology.link_percent','[]');
INSERT INTO setting VALUES(18,'machine.node.flop_rate','55 Mflop/s');
INSERT INTO setting VALUES(19,'machine.node.clock','300 MHz');
INSERT INTO setting VALUES(20,'machine.node.div','23 cycles');
INSERT INTO setting VALUES(21,'machine.node.sqrt','85 cycles');
INSERT INTO setting VALUES(22,'machine.node.trig','150 cycles');
INSERT INTO setting VALUES(23,'machine.node.call','50 ns');
INSERT INTO setting VALUES(24,'machine.node.copy.bandwidth','600 MB/s');
INSERT INTO setting VALUES(25,'machine.network.level','link');
INSERT INTO setting VALUES(26,'machine.network.tolerance','2 %');
INSERT INTO setting VALUES(27,'machine.network.link.bandwidth','480 MB/s');
INSERT INTO setting VALUES(28,'machine.network.injection.bandwidth','340 MB/s');
INSERT INTO setting VALUES(29,'machine.network.ejection.bandwidth','480 MB/s');
INSERT INTO setting VALUES(30,'machine.network.hop_latency','60 ns');
INSERT INTO setting VALUES(31,'machine.network.end_latency','2.88 us');
INSERT INTO setting VALUES(32,'machine.network.credit_latency','27 ns');
INSERT INTO setting VALUES(33,'machine.network.flit','8 B');
INSERT INTO setting VALUES(34,'machine.network.packet','64 B');
INSERT INTO setting VALUES(35,'machine.network.header','0 B');
INSERT INTO setting VALUES(36,'machine.network.virtual_channels','2');
INSERT INTO setting VALUES(37,'machine.network.buffer','22');
INSERT INTO setting VALUES(38,'machine.network.arbitration','round-robin');
INSERT INTO setting VALUES(39,'machine.software.send.overhead','6 us');
INSERT INTO setting VALUES(40,'machine.software.send.copy','1.471 ns/B');
INSERT INTO setting VALUES(41,'machine.software.recv.overhead','7 us');
INSERT INTO setting VALUES(42,'machine.software.recv.copy','1.471 ns/B');
INSERT INTO setting VALUES(43,'machine.software.gap','8 us');
INSERT INTO setting VALUES(44,'machine.software.gap_per_byte','0 s/B');
INSERT INTO setting VALUES(45,'machine.software.short.limit','0 B');
INSERT INTO setting VALUES(46,'machine.software.short.saving','0 s');
INSERT INTO setting VALUES(47,'machine.software.short.copy','0 s/B');
INSERT INTO setting VALUES(48,'machine.software.eager.limit','4 KiB');
INSERT INTO setting VALUES(49,'machine.software.eager.copy','0 s/B');
INSERT INTO setting VALUES(50,'machine.software.rendezvous.latency','0 s');
INSERT INTO setting VALUES(51,'machine.software.kernel.server','false');
INSERT INTO setting VALUES(52,'machine.software.kernel.time','0 s');
INSERT INTO setting VALUES(53,'machine.software.kernel.per_byte','0 s/B');
INSERT INTO setting VALUES(54,'machine.software.barrier.kind','hardware');
INSERT INTO setting VALUES(55,'machine.software.barrier.time','8 us');
INSERT INTO setting VALUES(56,'machine.software.shared.latency','0 s');
INSERT INTO setting VALUES(57,'machine.software.shared.bandwidth','0 B/s');
INSERT INTO setting VALUES(58,'machine.placement.kind','linear');
INSERT INTO setting VALUES(59,'machine.placement.spread','block');
INSERT INTO setting VALUES(60,'machine.placement.seed','1');
INSERT INTO setting VALUES(61,'machine.placement.list','[]');
INSERT INTO setting VALUES(62,'machine.noise.compute','0 %');
INSERT INTO setting VALUES(63,'machine.noise.background.load','0 %');
INSERT INTO setting VALUES(64,'machine.noise.background.message','1 KiB');
INSERT INTO setting VALUES(65,'model.generator','serial-chain');
INSERT INTO setting VALUES(66,'model.n','2');
INSERT INTO setting VALUES(67,'model.joint','revolute');
INSERT INTO setting VALUES(68,'model.base','fixed');
INSERT INTO setting VALUES(69,'model.inertia','uniform');
INSERT INTO setting VALUES(70,'model.pose','random');
INSERT INTO setting VALUES(71,'model.axes','twisted');
INSERT INTO setting VALUES(72,'model.length','1 m');
INSERT INTO setting VALUES(73,'model.radius','50 mm');
INSERT INTO setting VALUES(74,'model.mass','1 kg');
INSERT INTO setting VALUES(75,'model.mass_ratio','1');
INSERT INTO setting VALUES(76,'model.gravity','[0 m/s^2, 0 m/s^2, -9.81 m/s^2]');
INSERT INTO setting VALUES(77,'model.base_acceleration.angular','[0 rad/s^2, 0 rad/s^2, 0 rad/s^2]');
INSERT INTO setting VALUES(78,'model.base_acceleration.linear','[0 m/s^2, 0 m/s^2, 0 m/s^2]');
INSERT INTO setting VALUES(79,'model.rate','1 rad/s');
INSERT INTO setting VALUES(80,'model.torque','1 N m');
INSERT INTO setting VALUES(81,'model.external_force','0 N');
INSERT INTO setting VALUES(82,'model.stiffness','0 N m/rad');
INSERT INTO setting VALUES(83,'model.damping','0 N m s/rad');
INSERT INTO setting VALUES(84,'model.stabilisation','0 rad/s');
INSERT INTO setting VALUES(85,'model.branch','2');
INSERT INTO setting VALUES(86,'model.seed','1');
INSERT INTO setting VALUES(87,'model.path','');
INSERT INTO setting VALUES(88,'kernel.name','dynamics');
INSERT INTO setting VALUES(89,'kernel.formulation','paper');
INSERT INTO setting VALUES(90,'kernel.solver','pcr-symmetric');
INSERT INTO setting VALUES(91,'kernel.part_solver','pcr');
INSERT INTO setting VALUES(92,'kernel.operators','structured');
INSERT INTO setting VALUES(93,'kernel.algebra','auto');
INSERT INTO setting VALUES(94,'kernel.precision','double');
INSERT INTO setting VALUES(95,'kernel.partition','block');
INSERT INTO setting VALUES(96,'kernel.composites_incoming','false');
INSERT INTO setting VALUES(97,'kernel.hybrid_levels','1');
INSERT INTO setting VALUES(98,'kernel.refinement','as-needed');
INSERT INTO setting VALUES(99,'kernel.residual','working');
INSERT INTO setting VALUES(100,'kernel.inner_refinements','0');
INSERT INTO setting VALUES(101,'kernel.outer_refinements','0');
INSERT INTO setting VALUES(102,'kernel.steps','0');
INSERT INTO setting VALUES(103,'kernel.step_size','1 ms');
INSERT INTO setting VALUES(104,'kernel.step','semi-implicit');
INSERT INTO setting VALUES(105,'kernel.repeat','1');
INSERT INTO setting VALUES(106,'kernel.message','0 B');
INSERT INTO setting VALUES(107,'kernel.distance','1');
INSERT INTO setting VALUES(108,'ranks','4');
INSERT INTO setting VALUES(109,'model.n','4');
INSERT INTO setting VALUES(110,'machine.network.level','loggp');
INSERT INTO setting VALUES(111,'ranks','3');
INSERT INTO setting VALUES(112,'machine.network.level','auto-tolerance');
INSERT INTO setting VALUES(113,'machine.network.tolerance','3 %');
INSERT INTO setting VALUES(114,'model.n','3');
INSERT INTO setting VALUES(115,'seed','9');
INSERT INTO setting VALUES(116,'machine.noise.compute','5 %');
CREATE TABLE run_setting (
    run_id     INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    setting_id INTEGER NOT NULL REFERENCES setting (id),
    PRIMARY KEY (run_id, setting_id)
) STRICT, WITHOUT ROWID;
INSERT INTO run_setting VALUES(1,1);
INSERT INTO run_setting VALUES(1,2);
INSERT INTO run_setting VALUES(1,3);
INSERT INTO run_setting VALUES(1,4);
INSERT INTO run_setting VALUES(1,5);
INSERT INTO run_setting VALUES(1,6);
INSERT INTO run_setting VALUES(1,7);
INSERT INTO run_setting VALUES(1,8);
INSERT INTO run_setting VALUES(1,9);
INSERT INTO run_setting VALUES(1,10);
INSERT INTO run_setting VALUES(1,11);
INSERT INTO run_setting VALUES(1,12);
INSERT INTO run_setting VALUES(1,13);
INSERT INTO run_setting VALUES(1,14);
INSERT INTO run_setting VALUES(1,15);
INSERT INTO run_setting VALUES(1,16);
INSERT INTO run_setting VALUES(1,17);
INSERT INTO run_setting VALUES(1,18);
INSERT INTO run_setting VALUES(1,19);
INSERT INTO run_setting VALUES(1,20);
INSERT INTO run_setting VALUES(1,21);
INSERT INTO run_setting VALUES(1,22);
INSERT INTO run_setting VALUES(1,23);
INSERT INTO run_setting VALUES(1,24);
INSERT INTO run_setting VALUES(1,25);
INSERT INTO run_setting VALUES(1,26);
INSERT INTO run_setting VALUES(1,27);
INSERT INTO run_setting VALUES(1,28);
INSERT INTO run_setting VALUES(1,29);
INSERT INTO run_setting VALUES(1,30);
INSERT INTO run_setting VALUES(1,31);
INSERT INTO run_setting VALUES(1,32);
INSERT INTO run_setting VALUES(1,33);
INSERT INTO run_setting VALUES(1,34);
INSERT INTO run_setting VALUES(1,35);
INSERT INTO run_setting VALUES(1,36);
INSERT INTO run_setting VALUES(1,37);
INSERT INTO run_setting VALUES(1,38);
INSERT INTO run_setting VALUES(1,39);
INSERT INTO run_setting VALUES(1,40);
INSERT INTO run_setting VALUES(1,41);
INSERT INTO run_setting VALUES(1,42);
INSERT INTO run_setting VALUES(1,43);
INSERT INTO run_setting VALUES(1,44);
INSERT INTO run_setting VALUES(1,45);
INSERT INTO run_setting VALUES(1,46);
INSERT INTO run_setting VALUES(1,47);
INSERT INTO run_setting VALUES(1,48);
INSERT INTO run_setting VALUES(1,49);
INSERT INTO run_setting VALUES(1,50);
INSERT INTO run_setting VALUES(1,51);
INSERT INTO run_setting VALUES(1,52);
INSERT INTO run_setting VALUES(1,53);
INSERT INTO run_setting VALUES(1,54);
INSERT INTO run_setting VALUES(1,55);
INSERT INTO run_setting VALUES(1,56);
INSERT INTO run_setting VALUES(1,57);
INSERT INTO run_setting VALUES(1,58);
INSERT INTO run_setting VALUES(1,59);
INSERT INTO run_setting VALUES(1,60);
INSERT INTO run_setting VALUES(1,61);
INSERT INTO run_setting VALUES(1,62);
INSERT INTO run_setting VALUES(1,63);
INSERT INTO run_setting VALUES(1,64);
INSERT INTO run_setting VALUES(1,65);
INSERT INTO run_setting VALUES(1,66);
INSERT INTO run_setting VALUES(1,67);
INSERT INTO run_setting VALUES(1,68);
INSERT INTO run_setting VALUES(1,69);
INSERT INTO run_setting VALUES(1,70);
INSERT INTO run_setting VALUES(1,71);
INSERT INTO run_setting VALUES(1,72);
INSERT INTO run_setting VALUES(1,73);
INSERT INTO run_setting VALUES(1,74);
INSERT INTO run_setting VALUES(1,75);
INSERT INTO run_setting VALUES(1,76);
INSERT INTO run_setting VALUES(1,77);
INSERT INTO run_setting VALUES(1,78);
INSERT INTO run_setting VALUES(1,79);
INSERT INTO run_setting VALUES(1,80);
INSERT INTO run_setting VALUES(1,81);
INSERT INTO run_setting VALUES(1,82);
INSERT INTO run_setting VALUES(1,83);
INSERT INTO run_setting VALUES(1,84);
INSERT INTO run_setting VALUES(1,85);
INSERT INTO run_setting VALUES(1,86);
INSERT INTO run_setting VALUES(1,87);
INSERT INTO run_setting VALUES(1,88);
INSERT INTO run_setting VALUES(1,89);
INSERT INTO run_setting VALUES(1,90);
INSERT INTO run_setting VALUES(1,91);
INSERT INTO run_setting VALUES(1,92);
INSERT INTO run_setting VALUES(1,93);
INSERT INTO run_setting VALUES(1,94);
INSERT INTO run_setting VALUES(1,95);
INSERT INTO run_setting VALUES(1,96);
INSERT INTO run_setting VALUES(1,97);
INSERT INTO run_setting VALUES(1,98);
INSERT INTO run_setting VALUES(1,99);
INSERT INTO run_setting VALUES(1,100);
INSERT INTO run_setting VALUES(1,101);
INSERT INTO run_setting VALUES(1,102);
INSERT INTO run_setting VALUES(1,103);
INSERT INTO run_setting VALUES(1,104);
INSERT INTO run_setting VALUES(1,105);
INSERT INTO run_setting VALUES(1,106);
INSERT INTO run_setting VALUES(1,107);
INSERT INTO run_setting VALUES(2,1);
INSERT INTO run_setting VALUES(2,3);
INSERT INTO run_setting VALUES(2,4);
INSERT INTO run_setting VALUES(2,5);
INSERT INTO run_setting VALUES(2,6);
INSERT INTO run_setting VALUES(2,7);
INSERT INTO run_setting VALUES(2,8);
INSERT INTO run_setting VALUES(2,9);
INSERT INTO run_setting VALUES(2,10);
INSERT INTO run_setting VALUES(2,11);
INSERT INTO run_setting VALUES(2,12);
INSERT INTO run_setting VALUES(2,13);
INSERT INTO run_setting VALUES(2,14);
INSERT INTO run_setting VALUES(2,15);
INSERT INTO run_setting VALUES(2,16);
INSERT INTO run_setting VALUES(2,17);
INSERT INTO run_setting VALUES(2,18);
INSERT INTO run_setting VALUES(2,19);
INSERT INTO run_setting VALUES(2,20);
INSERT INTO run_setting VALUES(2,21);
INSERT INTO run_setting VALUES(2,22);
INSERT INTO run_setting VALUES(2,23);
INSERT INTO run_setting VALUES(2,24);
INSERT INTO run_setting VALUES(2,25);
INSERT INTO run_setting VALUES(2,26);
INSERT INTO run_setting VALUES(2,27);
INSERT INTO run_setting VALUES(2,28);
INSERT INTO run_setting VALUES(2,29);
INSERT INTO run_setting VALUES(2,30);
INSERT INTO run_setting VALUES(2,31);
INSERT INTO run_setting VALUES(2,32);
INSERT INTO run_setting VALUES(2,33);
INSERT INTO run_setting VALUES(2,34);
INSERT INTO run_setting VALUES(2,35);
INSERT INTO run_setting VALUES(2,36);
INSERT INTO run_setting VALUES(2,37);
INSERT INTO run_setting VALUES(2,38);
INSERT INTO run_setting VALUES(2,39);
INSERT INTO run_setting VALUES(2,40);
INSERT INTO run_setting VALUES(2,41);
INSERT INTO run_setting VALUES(2,42);
INSERT INTO run_setting VALUES(2,43);
INSERT INTO run_setting VALUES(2,44);
INSERT INTO run_setting VALUES(2,45);
INSERT INTO run_setting VALUES(2,46);
INSERT INTO run_setting VALUES(2,47);
INSERT INTO run_setting VALUES(2,48);
INSERT INTO run_setting VALUES(2,49);
INSERT INTO run_setting VALUES(2,50);
INSERT INTO run_setting VALUES(2,51);
INSERT INTO run_setting VALUES(2,52);
INSERT INTO run_setting VALUES(2,53);
INSERT INTO run_setting VALUES(2,54);
INSERT INTO run_setting VALUES(2,55);
INSERT INTO run_setting VALUES(2,56);
INSERT INTO run_setting VALUES(2,57);
INSERT INTO run_setting VALUES(2,58);
INSERT INTO run_setting VALUES(2,59);
INSERT INTO run_setting VALUES(2,60);
INSERT INTO run_setting VALUES(2,61);
INSERT INTO run_setting VALUES(2,62);
INSERT INTO run_setting VALUES(2,63);
INSERT INTO run_setting VALUES(2,64);
INSERT INTO run_setting VALUES(2,65);
INSERT INTO run_setting VALUES(2,67);
INSERT INTO run_setting VALUES(2,68);
INSERT INTO run_setting VALUES(2,69);
INSERT INTO run_setting VALUES(2,70);
INSERT INTO run_setting VALUES(2,71);
INSERT INTO run_setting VALUES(2,72);
INSERT INTO run_setting VALUES(2,73);
INSERT INTO run_setting VALUES(2,74);
INSERT INTO run_setting VALUES(2,75);
INSERT INTO run_setting VALUES(2,76);
INSERT INTO run_setting VALUES(2,77);
INSERT INTO run_setting VALUES(2,78);
INSERT INTO run_setting VALUES(2,79);
INSERT INTO run_setting VALUES(2,80);
INSERT INTO run_setting VALUES(2,81);
INSERT INTO run_setting VALUES(2,82);
INSERT INTO run_setting VALUES(2,83);
INSERT INTO run_setting VALUES(2,84);
INSERT INTO run_setting VALUES(2,85);
INSERT INTO run_setting VALUES(2,86);
INSERT INTO run_setting VALUES(2,87);
INSERT INTO run_setting VALUES(2,88);
INSERT INTO run_setting VALUES(2,89);
INSERT INTO run_setting VALUES(2,90);
INSERT INTO run_setting VALUES(2,91);
INSERT INTO run_setting VALUES(2,92);
INSERT INTO run_setting VALUES(2,93);
INSERT INTO run_setting VALUES(2,94);
INSERT INTO run_setting VALUES(2,95);
INSERT INTO run_setting VALUES(2,96);
INSERT INTO run_setting VALUES(2,97);
INSERT INTO run_setting VALUES(2,98);
INSERT INTO run_setting VALUES(2,99);
INSERT INTO run_setting VALUES(2,100);
INSERT INTO run_setting VALUES(2,101);
INSERT INTO run_setting VALUES(2,102);
INSERT INTO run_setting VALUES(2,103);
INSERT INTO run_setting VALUES(2,104);
INSERT INTO run_setting VALUES(2,105);
INSERT INTO run_setting VALUES(2,106);
INSERT INTO run_setting VALUES(2,107);
INSERT INTO run_setting VALUES(2,108);
INSERT INTO run_setting VALUES(2,109);
INSERT INTO run_setting VALUES(3,1);
INSERT INTO run_setting VALUES(3,2);
INSERT INTO run_setting VALUES(3,3);
INSERT INTO run_setting VALUES(3,4);
INSERT INTO run_setting VALUES(3,5);
INSERT INTO run_setting VALUES(3,6);
INSERT INTO run_setting VALUES(3,7);
INSERT INTO run_setting VALUES(3,8);
INSERT INTO run_setting VALUES(3,9);
INSERT INTO run_setting VALUES(3,10);
INSERT INTO run_setting VALUES(3,11);
INSERT INTO run_setting VALUES(3,12);
INSERT INTO run_setting VALUES(3,13);
INSERT INTO run_setting VALUES(3,14);
INSERT INTO run_setting VALUES(3,15);
INSERT INTO run_setting VALUES(3,16);
INSERT INTO run_setting VALUES(3,17);
INSERT INTO run_setting VALUES(3,18);
INSERT INTO run_setting VALUES(3,19);
INSERT INTO run_setting VALUES(3,20);
INSERT INTO run_setting VALUES(3,21);
INSERT INTO run_setting VALUES(3,22);
INSERT INTO run_setting VALUES(3,23);
INSERT INTO run_setting VALUES(3,24);
INSERT INTO run_setting VALUES(3,26);
INSERT INTO run_setting VALUES(3,27);
INSERT INTO run_setting VALUES(3,28);
INSERT INTO run_setting VALUES(3,29);
INSERT INTO run_setting VALUES(3,30);
INSERT INTO run_setting VALUES(3,31);
INSERT INTO run_setting VALUES(3,32);
INSERT INTO run_setting VALUES(3,33);
INSERT INTO run_setting VALUES(3,34);
INSERT INTO run_setting VALUES(3,35);
INSERT INTO run_setting VALUES(3,36);
INSERT INTO run_setting VALUES(3,37);
INSERT INTO run_setting VALUES(3,38);
INSERT INTO run_setting VALUES(3,39);
INSERT INTO run_setting VALUES(3,40);
INSERT INTO run_setting VALUES(3,41);
INSERT INTO run_setting VALUES(3,42);
INSERT INTO run_setting VALUES(3,43);
INSERT INTO run_setting VALUES(3,44);
INSERT INTO run_setting VALUES(3,45);
INSERT INTO run_setting VALUES(3,46);
INSERT INTO run_setting VALUES(3,47);
INSERT INTO run_setting VALUES(3,48);
INSERT INTO run_setting VALUES(3,49);
INSERT INTO run_setting VALUES(3,50);
INSERT INTO run_setting VALUES(3,51);
INSERT INTO run_setting VALUES(3,52);
INSERT INTO run_setting VALUES(3,53);
INSERT INTO run_setting VALUES(3,54);
INSERT INTO run_setting VALUES(3,55);
INSERT INTO run_setting VALUES(3,56);
INSERT INTO run_setting VALUES(3,57);
INSERT INTO run_setting VALUES(3,58);
INSERT INTO run_setting VALUES(3,59);
INSERT INTO run_setting VALUES(3,60);
INSERT INTO run_setting VALUES(3,61);
INSERT INTO run_setting VALUES(3,62);
INSERT INTO run_setting VALUES(3,63);
INSERT INTO run_setting VALUES(3,64);
INSERT INTO run_setting VALUES(3,65);
INSERT INTO run_setting VALUES(3,66);
INSERT INTO run_setting VALUES(3,67);
INSERT INTO run_setting VALUES(3,68);
INSERT INTO run_setting VALUES(3,69);
INSERT INTO run_setting VALUES(3,70);
INSERT INTO run_setting VALUES(3,71);
INSERT INTO run_setting VALUES(3,72);
INSERT INTO run_setting VALUES(3,73);
INSERT INTO run_setting VALUES(3,74);
INSERT INTO run_setting VALUES(3,75);
INSERT INTO run_setting VALUES(3,76);
INSERT INTO run_setting VALUES(3,77);
INSERT INTO run_setting VALUES(3,78);
INSERT INTO run_setting VALUES(3,79);
INSERT INTO run_setting VALUES(3,80);
INSERT INTO run_setting VALUES(3,81);
INSERT INTO run_setting VALUES(3,82);
INSERT INTO run_setting VALUES(3,83);
INSERT INTO run_setting VALUES(3,84);
INSERT INTO run_setting VALUES(3,85);
INSERT INTO run_setting VALUES(3,86);
INSERT INTO run_setting VALUES(3,87);
INSERT INTO run_setting VALUES(3,88);
INSERT INTO run_setting VALUES(3,89);
INSERT INTO run_setting VALUES(3,90);
INSERT INTO run_setting VALUES(3,91);
INSERT INTO run_setting VALUES(3,92);
INSERT INTO run_setting VALUES(3,93);
INSERT INTO run_setting VALUES(3,94);
INSERT INTO run_setting VALUES(3,95);
INSERT INTO run_setting VALUES(3,96);
INSERT INTO run_setting VALUES(3,97);
INSERT INTO run_setting VALUES(3,98);
INSERT INTO run_setting VALUES(3,99);
INSERT INTO run_setting VALUES(3,100);
INSERT INTO run_setting VALUES(3,101);
INSERT INTO run_setting VALUES(3,102);
INSERT INTO run_setting VALUES(3,103);
INSERT INTO run_setting VALUES(3,104);
INSERT INTO run_setting VALUES(3,105);
INSERT INTO run_setting VALUES(3,106);
INSERT INTO run_setting VALUES(3,107);
INSERT INTO run_setting VALUES(3,110);
INSERT INTO run_setting VALUES(4,1);
INSERT INTO run_setting VALUES(4,3);
INSERT INTO run_setting VALUES(4,4);
INSERT INTO run_setting VALUES(4,5);
INSERT INTO run_setting VALUES(4,6);
INSERT INTO run_setting VALUES(4,7);
INSERT INTO run_setting VALUES(4,8);
INSERT INTO run_setting VALUES(4,9);
INSERT INTO run_setting VALUES(4,10);
INSERT INTO run_setting VALUES(4,11);
INSERT INTO run_setting VALUES(4,12);
INSERT INTO run_setting VALUES(4,13);
INSERT INTO run_setting VALUES(4,14);
INSERT INTO run_setting VALUES(4,15);
INSERT INTO run_setting VALUES(4,16);
INSERT INTO run_setting VALUES(4,17);
INSERT INTO run_setting VALUES(4,18);
INSERT INTO run_setting VALUES(4,19);
INSERT INTO run_setting VALUES(4,20);
INSERT INTO run_setting VALUES(4,21);
INSERT INTO run_setting VALUES(4,22);
INSERT INTO run_setting VALUES(4,23);
INSERT INTO run_setting VALUES(4,24);
INSERT INTO run_setting VALUES(4,26);
INSERT INTO run_setting VALUES(4,27);
INSERT INTO run_setting VALUES(4,28);
INSERT INTO run_setting VALUES(4,29);
INSERT INTO run_setting VALUES(4,30);
INSERT INTO run_setting VALUES(4,31);
INSERT INTO run_setting VALUES(4,32);
INSERT INTO run_setting VALUES(4,33);
INSERT INTO run_setting VALUES(4,34);
INSERT INTO run_setting VALUES(4,35);
INSERT INTO run_setting VALUES(4,36);
INSERT INTO run_setting VALUES(4,37);
INSERT INTO run_setting VALUES(4,38);
INSERT INTO run_setting VALUES(4,39);
INSERT INTO run_setting VALUES(4,40);
INSERT INTO run_setting VALUES(4,41);
INSERT INTO run_setting VALUES(4,42);
INSERT INTO run_setting VALUES(4,43);
INSERT INTO run_setting VALUES(4,44);
INSERT INTO run_setting VALUES(4,45);
INSERT INTO run_setting VALUES(4,46);
INSERT INTO run_setting VALUES(4,47);
INSERT INTO run_setting VALUES(4,48);
INSERT INTO run_setting VALUES(4,49);
INSERT INTO run_setting VALUES(4,50);
INSERT INTO run_setting VALUES(4,51);
INSERT INTO run_setting VALUES(4,52);
INSERT INTO run_setting VALUES(4,53);
INSERT INTO run_setting VALUES(4,54);
INSERT INTO run_setting VALUES(4,55);
INSERT INTO run_setting VALUES(4,56);
INSERT INTO run_setting VALUES(4,57);
INSERT INTO run_setting VALUES(4,58);
INSERT INTO run_setting VALUES(4,59);
INSERT INTO run_setting VALUES(4,60);
INSERT INTO run_setting VALUES(4,61);
INSERT INTO run_setting VALUES(4,62);
INSERT INTO run_setting VALUES(4,63);
INSERT INTO run_setting VALUES(4,64);
INSERT INTO run_setting VALUES(4,65);
INSERT INTO run_setting VALUES(4,67);
INSERT INTO run_setting VALUES(4,68);
INSERT INTO run_setting VALUES(4,69);
INSERT INTO run_setting VALUES(4,70);
INSERT INTO run_setting VALUES(4,71);
INSERT INTO run_setting VALUES(4,72);
INSERT INTO run_setting VALUES(4,73);
INSERT INTO run_setting VALUES(4,74);
INSERT INTO run_setting VALUES(4,75);
INSERT INTO run_setting VALUES(4,76);
INSERT INTO run_setting VALUES(4,77);
INSERT INTO run_setting VALUES(4,78);
INSERT INTO run_setting VALUES(4,79);
INSERT INTO run_setting VALUES(4,80);
INSERT INTO run_setting VALUES(4,81);
INSERT INTO run_setting VALUES(4,82);
INSERT INTO run_setting VALUES(4,83);
INSERT INTO run_setting VALUES(4,84);
INSERT INTO run_setting VALUES(4,85);
INSERT INTO run_setting VALUES(4,86);
INSERT INTO run_setting VALUES(4,87);
INSERT INTO run_setting VALUES(4,88);
INSERT INTO run_setting VALUES(4,89);
INSERT INTO run_setting VALUES(4,90);
INSERT INTO run_setting VALUES(4,91);
INSERT INTO run_setting VALUES(4,92);
INSERT INTO run_setting VALUES(4,93);
INSERT INTO run_setting VALUES(4,94);
INSERT INTO run_setting VALUES(4,95);
INSERT INTO run_setting VALUES(4,96);
INSERT INTO run_setting VALUES(4,97);
INSERT INTO run_setting VALUES(4,98);
INSERT INTO run_setting VALUES(4,99);
INSERT INTO run_setting VALUES(4,100);
INSERT INTO run_setting VALUES(4,101);
INSERT INTO run_setting VALUES(4,102);
INSERT INTO run_setting VALUES(4,103);
INSERT INTO run_setting VALUES(4,104);
INSERT INTO run_setting VALUES(4,105);
INSERT INTO run_setting VALUES(4,106);
INSERT INTO run_setting VALUES(4,107);
INSERT INTO run_setting VALUES(4,108);
INSERT INTO run_setting VALUES(4,109);
INSERT INTO run_setting VALUES(4,110);
INSERT INTO run_setting VALUES(5,1);
INSERT INTO run_setting VALUES(5,3);
INSERT INTO run_setting VALUES(5,4);
INSERT INTO run_setting VALUES(5,5);
INSERT INTO run_setting VALUES(5,6);
INSERT INTO run_setting VALUES(5,7);
INSERT INTO run_setting VALUES(5,8);
INSERT INTO run_setting VALUES(5,9);
INSERT INTO run_setting VALUES(5,10);
INSERT INTO run_setting VALUES(5,11);
INSERT INTO run_setting VALUES(5,12);
INSERT INTO run_setting VALUES(5,13);
INSERT INTO run_setting VALUES(5,14);
INSERT INTO run_setting VALUES(5,15);
INSERT INTO run_setting VALUES(5,16);
INSERT INTO run_setting VALUES(5,17);
INSERT INTO run_setting VALUES(5,18);
INSERT INTO run_setting VALUES(5,19);
INSERT INTO run_setting VALUES(5,20);
INSERT INTO run_setting VALUES(5,21);
INSERT INTO run_setting VALUES(5,22);
INSERT INTO run_setting VALUES(5,23);
INSERT INTO run_setting VALUES(5,24);
INSERT INTO run_setting VALUES(5,27);
INSERT INTO run_setting VALUES(5,28);
INSERT INTO run_setting VALUES(5,29);
INSERT INTO run_setting VALUES(5,30);
INSERT INTO run_setting VALUES(5,31);
INSERT INTO run_setting VALUES(5,32);
INSERT INTO run_setting VALUES(5,33);
INSERT INTO run_setting VALUES(5,34);
INSERT INTO run_setting VALUES(5,35);
INSERT INTO run_setting VALUES(5,36);
INSERT INTO run_setting VALUES(5,37);
INSERT INTO run_setting VALUES(5,38);
INSERT INTO run_setting VALUES(5,39);
INSERT INTO run_setting VALUES(5,40);
INSERT INTO run_setting VALUES(5,41);
INSERT INTO run_setting VALUES(5,42);
INSERT INTO run_setting VALUES(5,43);
INSERT INTO run_setting VALUES(5,44);
INSERT INTO run_setting VALUES(5,45);
INSERT INTO run_setting VALUES(5,46);
INSERT INTO run_setting VALUES(5,47);
INSERT INTO run_setting VALUES(5,48);
INSERT INTO run_setting VALUES(5,49);
INSERT INTO run_setting VALUES(5,50);
INSERT INTO run_setting VALUES(5,51);
INSERT INTO run_setting VALUES(5,52);
INSERT INTO run_setting VALUES(5,53);
INSERT INTO run_setting VALUES(5,54);
INSERT INTO run_setting VALUES(5,55);
INSERT INTO run_setting VALUES(5,56);
INSERT INTO run_setting VALUES(5,57);
INSERT INTO run_setting VALUES(5,58);
INSERT INTO run_setting VALUES(5,59);
INSERT INTO run_setting VALUES(5,60);
INSERT INTO run_setting VALUES(5,61);
INSERT INTO run_setting VALUES(5,62);
INSERT INTO run_setting VALUES(5,63);
INSERT INTO run_setting VALUES(5,64);
INSERT INTO run_setting VALUES(5,65);
INSERT INTO run_setting VALUES(5,67);
INSERT INTO run_setting VALUES(5,68);
INSERT INTO run_setting VALUES(5,69);
INSERT INTO run_setting VALUES(5,70);
INSERT INTO run_setting VALUES(5,71);
INSERT INTO run_setting VALUES(5,72);
INSERT INTO run_setting VALUES(5,73);
INSERT INTO run_setting VALUES(5,74);
INSERT INTO run_setting VALUES(5,75);
INSERT INTO run_setting VALUES(5,76);
INSERT INTO run_setting VALUES(5,77);
INSERT INTO run_setting VALUES(5,78);
INSERT INTO run_setting VALUES(5,79);
INSERT INTO run_setting VALUES(5,80);
INSERT INTO run_setting VALUES(5,81);
INSERT INTO run_setting VALUES(5,82);
INSERT INTO run_setting VALUES(5,83);
INSERT INTO run_setting VALUES(5,84);
INSERT INTO run_setting VALUES(5,85);
INSERT INTO run_setting VALUES(5,86);
INSERT INTO run_setting VALUES(5,87);
INSERT INTO run_setting VALUES(5,88);
INSERT INTO run_setting VALUES(5,89);
INSERT INTO run_setting VALUES(5,90);
INSERT INTO run_setting VALUES(5,91);
INSERT INTO run_setting VALUES(5,92);
INSERT INTO run_setting VALUES(5,93);
INSERT INTO run_setting VALUES(5,94);
INSERT INTO run_setting VALUES(5,95);
INSERT INTO run_setting VALUES(5,96);
INSERT INTO run_setting VALUES(5,97);
INSERT INTO run_setting VALUES(5,98);
INSERT INTO run_setting VALUES(5,99);
INSERT INTO run_setting VALUES(5,100);
INSERT INTO run_setting VALUES(5,101);
INSERT INTO run_setting VALUES(5,102);
INSERT INTO run_setting VALUES(5,103);
INSERT INTO run_setting VALUES(5,104);
INSERT INTO run_setting VALUES(5,105);
INSERT INTO run_setting VALUES(5,106);
INSERT INTO run_setting VALUES(5,107);
INSERT INTO run_setting VALUES(5,111);
INSERT INTO run_setting VALUES(5,112);
INSERT INTO run_setting VALUES(5,113);
INSERT INTO run_setting VALUES(5,114);
INSERT INTO run_setting VALUES(6,1);
INSERT INTO run_setting VALUES(6,2);
INSERT INTO run_setting VALUES(6,4);
INSERT INTO run_setting VALUES(6,5);
INSERT INTO run_setting VALUES(6,6);
INSERT INTO run_setting VALUES(6,7);
INSERT INTO run_setting VALUES(6,8);
INSERT INTO run_setting VALUES(6,9);
INSERT INTO run_setting VALUES(6,10);
INSERT INTO run_setting VALUES(6,11);
INSERT INTO run_setting VALUES(6,12);
INSERT INTO run_setting VALUES(6,13);
INSERT INTO run_setting VALUES(6,14);
INSERT INTO run_setting VALUES(6,15);
INSERT INTO run_setting VALUES(6,16);
INSERT INTO run_setting VALUES(6,17);
INSERT INTO run_setting VALUES(6,18);
INSERT INTO run_setting VALUES(6,19);
INSERT INTO run_setting VALUES(6,20);
INSERT INTO run_setting VALUES(6,21);
INSERT INTO run_setting VALUES(6,22);
INSERT INTO run_setting VALUES(6,23);
INSERT INTO run_setting VALUES(6,24);
INSERT INTO run_setting VALUES(6,25);
INSERT INTO run_setting VALUES(6,26);
INSERT INTO run_setting VALUES(6,27);
INSERT INTO run_setting VALUES(6,28);
INSERT INTO run_setting VALUES(6,29);
INSERT INTO run_setting VALUES(6,30);
INSERT INTO run_setting VALUES(6,31);
INSERT INTO run_setting VALUES(6,32);
INSERT INTO run_setting VALUES(6,33);
INSERT INTO run_setting VALUES(6,34);
INSERT INTO run_setting VALUES(6,35);
INSERT INTO run_setting VALUES(6,36);
INSERT INTO run_setting VALUES(6,37);
INSERT INTO run_setting VALUES(6,38);
INSERT INTO run_setting VALUES(6,39);
INSERT INTO run_setting VALUES(6,40);
INSERT INTO run_setting VALUES(6,41);
INSERT INTO run_setting VALUES(6,42);
INSERT INTO run_setting VALUES(6,43);
INSERT INTO run_setting VALUES(6,44);
INSERT INTO run_setting VALUES(6,45);
INSERT INTO run_setting VALUES(6,46);
INSERT INTO run_setting VALUES(6,47);
INSERT INTO run_setting VALUES(6,48);
INSERT INTO run_setting VALUES(6,49);
INSERT INTO run_setting VALUES(6,50);
INSERT INTO run_setting VALUES(6,51);
INSERT INTO run_setting VALUES(6,52);
INSERT INTO run_setting VALUES(6,53);
INSERT INTO run_setting VALUES(6,54);
INSERT INTO run_setting VALUES(6,55);
INSERT INTO run_setting VALUES(6,56);
INSERT INTO run_setting VALUES(6,57);
INSERT INTO run_setting VALUES(6,58);
INSERT INTO run_setting VALUES(6,59);
INSERT INTO run_setting VALUES(6,60);
INSERT INTO run_setting VALUES(6,61);
INSERT INTO run_setting VALUES(6,63);
INSERT INTO run_setting VALUES(6,64);
INSERT INTO run_setting VALUES(6,65);
INSERT INTO run_setting VALUES(6,66);
INSERT INTO run_setting VALUES(6,67);
INSERT INTO run_setting VALUES(6,68);
INSERT INTO run_setting VALUES(6,69);
INSERT INTO run_setting VALUES(6,70);
INSERT INTO run_setting VALUES(6,71);
INSERT INTO run_setting VALUES(6,72);
INSERT INTO run_setting VALUES(6,73);
INSERT INTO run_setting VALUES(6,74);
INSERT INTO run_setting VALUES(6,75);
INSERT INTO run_setting VALUES(6,76);
INSERT INTO run_setting VALUES(6,77);
INSERT INTO run_setting VALUES(6,78);
INSERT INTO run_setting VALUES(6,79);
INSERT INTO run_setting VALUES(6,80);
INSERT INTO run_setting VALUES(6,81);
INSERT INTO run_setting VALUES(6,82);
INSERT INTO run_setting VALUES(6,83);
INSERT INTO run_setting VALUES(6,84);
INSERT INTO run_setting VALUES(6,85);
INSERT INTO run_setting VALUES(6,86);
INSERT INTO run_setting VALUES(6,87);
INSERT INTO run_setting VALUES(6,88);
INSERT INTO run_setting VALUES(6,89);
INSERT INTO run_setting VALUES(6,90);
INSERT INTO run_setting VALUES(6,91);
INSERT INTO run_setting VALUES(6,92);
INSERT INTO run_setting VALUES(6,93);
INSERT INTO run_setting VALUES(6,94);
INSERT INTO run_setting VALUES(6,95);
INSERT INTO run_setting VALUES(6,96);
INSERT INTO run_setting VALUES(6,97);
INSERT INTO run_setting VALUES(6,98);
INSERT INTO run_setting VALUES(6,99);
INSERT INTO run_setting VALUES(6,100);
INSERT INTO run_setting VALUES(6,101);
INSERT INTO run_setting VALUES(6,102);
INSERT INTO run_setting VALUES(6,103);
INSERT INTO run_setting VALUES(6,104);
INSERT INTO run_setting VALUES(6,105);
INSERT INTO run_setting VALUES(6,106);
INSERT INTO run_setting VALUES(6,107);
INSERT INTO run_setting VALUES(6,115);
INSERT INTO run_setting VALUES(6,116);
CREATE TABLE stage (
    run_id            INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    stage             INTEGER NOT NULL,
    name              TEXT NOT NULL,
    compute_sum_ps    INTEGER, compute_min_ps    INTEGER NOT NULL, compute_max_ps    INTEGER NOT NULL,
    send_sum_ps       INTEGER, send_min_ps       INTEGER NOT NULL, send_max_ps       INTEGER NOT NULL,
    recv_sum_ps       INTEGER, recv_min_ps       INTEGER NOT NULL, recv_max_ps       INTEGER NOT NULL,
    wait_sum_ps       INTEGER, wait_min_ps       INTEGER NOT NULL, wait_max_ps       INTEGER NOT NULL,
    contention_sum_ps INTEGER, contention_min_ps INTEGER NOT NULL, contention_max_ps INTEGER NOT NULL,
    total_sum_ps      INTEGER, total_min_ps      INTEGER NOT NULL, total_max_ps      INTEGER NOT NULL,
    messages          INTEGER NOT NULL,
    sent_bytes        INTEGER NOT NULL,
    flops             INTEGER NOT NULL,
    divisions         INTEGER NOT NULL,
    square_roots      INTEGER NOT NULL,
    sines             INTEGER NOT NULL,
    copied_bytes      INTEGER NOT NULL,
    calls             INTEGER NOT NULL,
    PRIMARY KEY (run_id, stage)
) STRICT, WITHOUT ROWID;
INSERT INTO stage VALUES(1,0,'Pre-processing',7109093,2890910,4218183,12023536,6011768,6011768,14023536,7011768,7011768,6000000,3000000,3000000,0,0,0,39156165,18914446,20241719,2,16,94,0,0,10,0,8);
INSERT INTO stage VALUES(1,1,'NE[1]',1845454,218182,1627272,24423648,12141216,12282432,28423648,14141216,14282432,58276645,17472797,40803848,0,0,0,112969395,45523717,67445678,4,288,96,0,0,0,0,2);
INSERT INTO stage VALUES(1,2,'NE[2]',6218182,1972728,4245454,12141216,0,12141216,14141216,0,14141216,272726,0,272726,0,0,0,32773340,16386670,16386670,2,96,320,0,0,0,0,8);
INSERT INTO stage VALUES(1,3,'NE[3]',9881818,4018182,5863636,12141216,0,12141216,14141216,0,14141216,66082174,19110980,46971194,0,0,0,102246424,35270378,66976046,2,96,516,0,0,0,0,10);
INSERT INTO stage VALUES(1,4,'CFA[1]',14931818,4959091,9972727,12023536,6011768,6011768,14023536,7011768,7011768,9097344,0,9097344,0,0,0,50076234,17982627,32093607,2,16,813,0,0,0,0,3);
INSERT INTO stage VALUES(1,5,'CFA[2]',20515150,10257575,10257575,24823760,12294200,12529560,28823760,14294200,14529560,32870748,12858896,20011852,0,0,0,107033418,49940231,57093187,4,560,1000,20,0,0,0,16);
INSERT INTO stage VALUES(1,6,'CFA[3]',1200000,600000,600000,6058840,0,6058840,7058840,0,7058840,19305912,0,19305912,0,0,0,33623592,6658840,26964752,1,40,66,0,0,0,0,0);
INSERT INTO stage VALUES(1,7,'end',0,0,0,0,0,0,0,0,0,10152956,0,10152956,0,0,0,10152956,0,10152956,0,0,0,0,0,0,0,0);
INSERT INTO stage VALUES(2,0,'Pre-processing',15545459,2890910,4218183,36070608,6011768,12023536,42070608,7011768,14023536,14000000,0,11000000,0,0,0,107686675,20241719,30265255,6,48,206,0,0,22,0,16);
INSERT INTO stage VALUES(2,1,'NE[1]',14009090,436364,5863636,122118240,12282432,48847296,142118240,28282432,42706080,184518947,6517638,86998919,0,0,0,462764517,103934650,128000147,20,1440,732,0,0,0,0,14);
INSERT INTO stage VALUES(2,2,'NE[2]',17109090,2190910,5872726,60706080,0,24282432,70706080,0,28282432,19597626,0,16387602,0,0,0,168118876,30155158,46860944,10,480,886,0,0,0,0,20);
INSERT INTO stage VALUES(2,3,'NE[3]',25299998,4018182,7709090,60706080,0,24282432,70706080,0,28282432,192761175,30281960,86182388,0,0,0,349473333,58582574,122173910,10,480,1320,0,0,0,0,26);
INSERT INTO stage VALUES(2,4,'CFA[1]',44540908,4959091,14804545,36070608,6011768,12023536,42070608,7011768,14023536,30407810,0,26742798,0,0,0,153089934,21564138,49739061,6,48,2425,0,0,0,0,9);
INSERT INTO stage VALUES(2,5,'CFA[2]',93054540,18163635,28363635,100589520,18529560,31647520,116589520,21823760,36353320,105039188,5835290,49027056,0,0,0,415272768,102199765,107779371,16,3120,4700,60,0,0,0,60);
INSERT INTO stage VALUES(2,6,'CFA[3]',3018182,600000,909091,18176520,0,6058840,21176520,0,7058840,26743177,0,19305912,0,0,0,69114399,6658840,26964752,3,120,166,0,0,0,0,0);
INSERT INTO stage VALUES(2,7,'end',0,0,0,0,0,0,0,0,0,14469218,0,10462047,0,0,0,14469218,0,10462047,0,0,0,0,0,0,0,0);
INSERT INTO stage VALUES(3,0,'Pre-processing',7109093,2890910,4218183,12023536,6011768,6011768,14023536,7011768,7011768,6000000,3000000,3000000,0,0,0,39156165,18914446,20241719,2,16,94,0,0,10,0,8);
INSERT INTO stage VALUES(3,1,'NE[1]',1845454,218182,1627272,24423648,12141216,12282432,28423648,14141216,14282432,58276645,17472797,40803848,0,0,0,112969395,45523717,67445678,4,288,96,0,0,0,0,2);
INSERT INTO stage VALUES(3,2,'NE[2]',6218182,1972728,4245454,12141216,0,12141216,14141216,0,14141216,272726,0,272726,0,0,0,32773340,16386670,16386670,2,96,320,0,0,0,0,8);
INSERT INTO stage VALUES(3,3,'NE[3]',9881818,4018182,5863636,12141216,0,12141216,14141216,0,14141216,66082174,19110980,46971194,0,0,0,102246424,35270378,66976046,2,96,516,0,0,0,0,10);
INSERT INTO stage VALUES(3,4,'CFA[1]',14931818,4959091,9972727,12023536,6011768,6011768,14023536,7011768,7011768,9097344,0,9097344,0,0,0,50076234,17982627,32093607,2,16,813,0,0,0,0,3);
INSERT INTO stage VALUES(3,5,'CFA[2]',20515150,10257575,10257575,24823760,12294200,12529560,28823760,14294200,14529560,32870748,12858896,20011852,0,0,0,107033418,49940231,57093187,4,560,1000,20,0,0,0,16);
INSERT INTO stage VALUES(3,6,'CFA[3]',1200000,600000,600000,6058840,0,6058840,7058840,0,7058840,19305912,0,19305912,0,0,0,33623592,6658840,26964752,1,40,66,0,0,0,0,0);
INSERT INTO stage VALUES(3,7,'end',0,0,0,0,0,0,0,0,0,10152956,0,10152956,0,0,0,10152956,0,10152956,0,0,0,0,0,0,0,0);
INSERT INTO stage VALUES(4,0,'Pre-processing',15545459,2890910,4218183,36070608,6011768,12023536,42070608,7011768,14023536,14000000,0,11000000,0,0,0,107686675,20241719,30265255,6,48,206,0,0,22,0,16);
INSERT INTO stage VALUES(4,1,'NE[1]',14009090,436364,5863636,122118240,12282432,48847296,142118240,28282432,42706080,184518947,6517638,86998919,0,0,0,462764517,103934650,128000147,20,1440,732,0,0,0,0,14);
INSERT INTO stage VALUES(4,2,'NE[2]',17109090,2190910,5872726,60706080,0,24282432,70706080,0,28282432,19597626,0,16387602,0,0,0,168118876,30155158,46860944,10,480,886,0,0,0,0,20);
INSERT INTO stage VALUES(4,3,'NE[3]',25299998,4018182,7709090,60706080,0,24282432,70706080,0,28282432,192761175,30281960,86182388,0,0,0,349473333,58582574,122173910,10,480,1320,0,0,0,0,26);
INSERT INTO stage VALUES(4,4,'CFA[1]',44540908,4959091,14804545,36070608,6011768,12023536,42070608,7011768,14023536,30407810,0,26742798,0,0,0,153089934,21564138,49739061,6,48,2425,0,0,0,0,9);
INSERT INTO stage VALUES(4,5,'CFA[2]',93054540,18163635,28363635,100589520,18529560,31647520,116589520,21823760,36353320,105039188,5835290,49027056,0,0,0,415272768,102199765,107779371,16,3120,4700,60,0,0,0,60);
INSERT INTO stage VALUES(4,6,'CFA[3]',3018182,600000,909091,18176520,0,6058840,21176520,0,7058840,26743177,0,19305912,0,0,0,69114399,6658840,26964752,3,120,166,0,0,0,0,0);
INSERT INTO stage VALUES(4,7,'end',0,0,0,0,0,0,0,0,0,14469218,0,10462047,0,0,0,14469218,0,10462047,0,0,0,0,0,0,0,0);
INSERT INTO stage VALUES(5,0,'Pre-processing',11327276,2890910,4218183,24047072,6011768,12023536,28047072,7011768,14023536,14000000,0,11000000,0,0,0,77421420,20241719,30265255,4,32,150,0,0,16,0,12);
INSERT INTO stage VALUES(5,1,'NE[1]',7927272,436364,5645454,73270944,12282432,36706080,85270944,28282432,28564864,131662980,3494067,79851198,0,0,0,298132140,70469249,120852426,12,864,414,0,0,0,0,8);
INSERT INTO stage VALUES(5,2,'NE[2]',11663636,2190910,5872726,36423648,0,24282432,42423648,0,28282432,35565224,0,33416606,0,0,0,126076156,30155158,63299038,6,288,603,0,0,0,0,14);
INSERT INTO stage VALUES(5,3,'NE[3]',17590908,4018182,7709090,36423648,0,24282432,42423648,0,28282432,109912858,21218017,49926616,0,0,0,206351062,49518631,85918138,6,288,918,0,0,0,0,18);
INSERT INTO stage VALUES(5,4,'CFA[1]',29736363,4959091,14804545,24047072,6011768,12023536,28047072,7011768,14023536,25139999,0,20672190,0,0,0,106970506,22450436,43668453,4,32,1619,0,0,0,0,6);
INSERT INTO stage VALUES(5,5,'CFA[2]',58631815,18163635,22304545,62706640,18529560,25412160,72706640,21823760,28823760,101828357,23201282,41060012,0,0,0,295873452,96319378,99812327,10,1840,2925,45,0,0,0,40);
INSERT INTO stage VALUES(5,6,'CFA[3]',2109091,600000,909091,12117680,0,6058840,14117680,0,7058840,19305912,0,19305912,0,0,0,47650363,6658840,26964752,2,80,116,0,0,0,0,0);
INSERT INTO stage VALUES(5,7,'end',0,0,0,0,0,0,0,0,0,18583886,0,15798861,0,0,0,18583886,0,15798861,0,0,0,0,0,0,0,0);
INSERT INTO stage VALUES(6,0,'Pre-processing',7086355,2984190,4102165,12023536,6011768,6011768,14023536,7011768,7011768,6000000,2991596,3008404,0,0,0,39133427,18999322,20134105,2,16,94,0,0,10,0,8);
INSERT INTO stage VALUES(6,1,'NE[1]',1744068,218641,1525427,24423648,12141216,12282432,28423648,14141216,14282432,58367290,17665287,40702003,0,0,0,112958654,45614362,67344292,4,288,96,0,0,0,0,2);
INSERT INTO stage VALUES(6,2,'NE[2]',6253040,2008192,4244848,12141216,0,12141216,14141216,0,14141216,239408,0,239408,0,0,0,32774880,16386064,16388816,2,96,320,0,0,0,0,8);
INSERT INTO stage VALUES(6,3,'NE[3]',9870448,4150777,5719671,12141216,0,12141216,14141216,0,14141216,66351847,19130565,47221282,0,0,0,102504727,35422558,67082169,2,96,516,0,0,0,0,10);
INSERT INTO stage VALUES(6,4,'CFA[1]',14755637,4831303,9924334,12023536,6011768,6011768,14023536,7011768,7011768,8938621,0,8938621,0,0,0,49741330,17854839,31886491,2,16,813,0,0,0,0,3);
INSERT INTO stage VALUES(6,5,'CFA[2]',19940124,9708577,10231547,24823760,12294200,12529560,28823760,14294200,14529560,32145840,12828836,19317004,0,0,0,105733484,49361173,56372311,4,560,1000,20,0,0,0,16);
INSERT INTO stage VALUES(6,6,'CFA[3]',1176563,577673,598890,6058840,0,6058840,7058840,0,7058840,19134034,0,19134034,0,0,0,33428277,6657730,26770547,1,40,66,0,0,0,0,0);
INSERT INTO stage VALUES(6,7,'end',0,0,0,0,0,0,0,0,0,10131739,0,10131739,0,0,0,10131739,0,10131739,0,0,0,0,0,0,0,0);
CREATE TABLE rank_stage (
    run_id        INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    rank          INTEGER NOT NULL,
    stage         INTEGER NOT NULL,
    compute_ps    INTEGER NOT NULL,
    send_ps       INTEGER NOT NULL,
    recv_ps       INTEGER NOT NULL,
    wait_ps       INTEGER NOT NULL,
    contention_ps INTEGER NOT NULL,
    messages      INTEGER NOT NULL,
    sent_bytes    INTEGER NOT NULL,
    flops         INTEGER NOT NULL,
    PRIMARY KEY (run_id, rank, stage)
) STRICT, WITHOUT ROWID;
INSERT INTO rank_stage VALUES(1,0,0,4218183,6011768,7011768,3000000,0,1,8,56);
INSERT INTO rank_stage VALUES(1,0,1,1627272,12141216,14282432,17472797,0,2,96,84);
INSERT INTO rank_stage VALUES(1,0,2,4245454,12141216,0,0,0,2,96,217);
INSERT INTO rank_stage VALUES(1,0,3,5863636,0,14141216,46971194,0,0,0,306);
INSERT INTO rank_stage VALUES(1,0,4,4959091,6011768,7011768,0,0,1,8,270);
INSERT INTO rank_stage VALUES(1,0,5,10257575,12294200,14529560,12858896,0,2,200,500);
INSERT INTO rank_stage VALUES(1,0,6,600000,0,7058840,19305912,0,0,0,33);
INSERT INTO rank_stage VALUES(1,1,0,2890910,6011768,7011768,3000000,0,1,8,38);
INSERT INTO rank_stage VALUES(1,1,1,218182,12282432,14141216,40803848,0,2,192,12);
INSERT INTO rank_stage VALUES(1,1,2,1972728,0,14141216,272726,0,0,0,103);
INSERT INTO rank_stage VALUES(1,1,3,4018182,12141216,0,19110980,0,2,96,210);
INSERT INTO rank_stage VALUES(1,1,4,9972727,6011768,7011768,9097344,0,1,8,543);
INSERT INTO rank_stage VALUES(1,1,5,10257575,12529560,14294200,20011852,0,2,360,500);
INSERT INTO rank_stage VALUES(1,1,6,600000,6058840,0,0,0,1,40,33);
INSERT INTO rank_stage VALUES(1,1,7,0,0,0,10152956,0,0,0,0);
INSERT INTO rank_stage VALUES(2,0,0,4218183,6011768,7011768,3000000,0,1,8,56);
INSERT INTO rank_stage VALUES(2,0,1,5645454,24282432,28564864,51576534,0,4,192,294);
INSERT INTO rank_stage VALUES(2,0,2,5872726,24282432,0,0,0,4,192,301);
INSERT INTO rank_stage VALUES(2,0,3,7709090,0,28282432,86182388,0,0,0,402);
INSERT INTO rank_stage VALUES(2,0,4,4959091,6011768,7011768,3581511,0,1,8,270);
INSERT INTO rank_stage VALUES(2,0,5,18163635,18529560,22059120,43518030,0,3,360,900);
INSERT INTO rank_stage VALUES(2,0,6,600000,0,7058840,19305912,0,0,0,33);
INSERT INTO rank_stage VALUES(2,0,7,0,0,0,1558124,0,0,0,0);
INSERT INTO rank_stage VALUES(2,1,0,4218183,12023536,14023536,0,0,2,16,56);
INSERT INTO rank_stage VALUES(2,1,1,5863636,48847296,42706080,6517638,0,8,576,306);
INSERT INTO rank_stage VALUES(2,1,2,5227272,24282432,14141216,3210024,0,4,192,271);
INSERT INTO rank_stage VALUES(2,1,3,7709090,12141216,28282432,44382541,0,2,96,402);
INSERT INTO rank_stage VALUES(2,1,4,14804545,12023536,14023536,0,0,2,16,806);
INSERT INTO rank_stage VALUES(2,1,5,28363635,31647520,36353320,5835290,0,5,1120,1450);
INSERT INTO rank_stage VALUES(2,1,6,909091,6058840,7058840,1894102,0,1,40,50);
INSERT INTO rank_stage VALUES(2,1,7,0,0,0,2449047,0,0,0,0);
INSERT INTO rank_stage VALUES(2,2,0,4218183,12023536,14023536,0,0,2,16,56);
INSERT INTO rank_stage VALUES(2,2,1,2063636,36706080,42564864,39425856,0,6,480,108);
INSERT INTO rank_stage VALUES(2,2,2,3818182,12141216,28282432,0,0,2,96,199);
INSERT INTO rank_stage VALUES(2,2,3,5863636,24282432,14141216,31914286,0,4,192,306);
INSERT INTO rank_stage VALUES(2,2,4,14804545,12023536,14023536,83501,0,2,16,806);
INSERT INTO rank_stage VALUES(2,2,5,28363635,31647520,36353320,6658812,0,5,1120,1450);
INSERT INTO rank_stage VALUES(2,2,6,909091,6058840,7058840,5543163,0,1,40,50);
INSERT INTO rank_stage VALUES(2,3,0,2890910,6011768,7011768,11000000,0,1,8,38);
INSERT INTO rank_stage VALUES(2,3,1,436364,12282432,28282432,86998919,0,2,192,24);
INSERT INTO rank_stage VALUES(2,3,2,2190910,0,28282432,16387602,0,0,0,115);
INSERT INTO rank_stage VALUES(2,3,3,4018182,24282432,0,30281960,0,4,192,210);
INSERT INTO rank_stage VALUES(2,3,4,9972727,6011768,7011768,26742798,0,1,8,543);
INSERT INTO rank_stage VALUES(2,3,5,18163635,18764920,21823760,49027056,0,3,520,900);
INSERT INTO rank_stage VALUES(2,3,6,600000,6058840,0,0,0,1,40,33);
INSERT INTO rank_stage VALUES(2,3,7,0,0,0,10462047,0,0,0,0);
INSERT INTO rank_stage VALUES(3,0,0,4218183,6011768,7011768,3000000,0,1,8,56);
INSERT INTO rank_stage VALUES(3,0,1,1627272,12141216,14282432,17472797,0,2,96,84);
INSERT INTO rank_stage VALUES(3,0,2,4245454,12141216,0,0,0,2,96,217);
INSERT INTO rank_stage VALUES(3,0,3,5863636,0,14141216,46971194,0,0,0,306);
INSERT INTO rank_stage VALUES(3,0,4,4959091,6011768,7011768,0,0,1,8,270);
INSERT INTO rank_stage VALUES(3,0,5,10257575,12294200,14529560,12858896,0,2,200,500);
INSERT INTO rank_stage VALUES(3,0,6,600000,0,7058840,19305912,0,0,0,33);
INSERT INTO rank_stage VALUES(3,1,0,2890910,6011768,7011768,3000000,0,1,8,38);
INSERT INTO rank_stage VALUES(3,1,1,218182,12282432,14141216,40803848,0,2,192,12);
INSERT INTO rank_stage VALUES(3,1,2,1972728,0,14141216,272726,0,0,0,103);
INSERT INTO rank_stage VALUES(3,1,3,4018182,12141216,0,19110980,0,2,96,210);
INSERT INTO rank_stage VALUES(3,1,4,9972727,6011768,7011768,9097344,0,1,8,543);
INSERT INTO rank_stage VALUES(3,1,5,10257575,12529560,14294200,20011852,0,2,360,500);
INSERT INTO rank_stage VALUES(3,1,6,600000,6058840,0,0,0,1,40,33);
INSERT INTO rank_stage VALUES(3,1,7,0,0,0,10152956,0,0,0,0);
INSERT INTO rank_stage VALUES(4,0,0,4218183,6011768,7011768,3000000,0,1,8,56);
INSERT INTO rank_stage VALUES(4,0,1,5645454,24282432,28564864,51576534,0,4,192,294);
INSERT INTO rank_stage VALUES(4,0,2,5872726,24282432,0,0,0,4,192,301);
INSERT INTO rank_stage VALUES(4,0,3,7709090,0,28282432,86182388,0,0,0,402);
INSERT INTO rank_stage VALUES(4,0,4,4959091,6011768,7011768,3581511,0,1,8,270);
INSERT INTO rank_stage VALUES(4,0,5,18163635,18529560,22059120,43518030,0,3,360,900);
INSERT INTO rank_stage VALUES(4,0,6,600000,0,7058840,19305912,0,0,0,33);
INSERT INTO rank_stage VALUES(4,0,7,0,0,0,1558124,0,0,0,0);
INSERT INTO rank_stage VALUES(4,1,0,4218183,12023536,14023536,0,0,2,16,56);
INSERT INTO rank_stage VALUES(4,1,1,5863636,48847296,42706080,6517638,0,8,576,306);
INSERT INTO rank_stage VALUES(4,1,2,5227272,24282432,14141216,3210024,0,4,192,271);
INSERT INTO rank_stage VALUES(4,1,3,7709090,12141216,28282432,44382541,0,2,96,402);
INSERT INTO rank_stage VALUES(4,1,4,14804545,12023536,14023536,0,0,2,16,806);
INSERT INTO rank_stage VALUES(4,1,5,28363635,31647520,36353320,5835290,0,5,1120,1450);
INSERT INTO rank_stage VALUES(4,1,6,909091,6058840,7058840,1894102,0,1,40,50);
INSERT INTO rank_stage VALUES(4,1,7,0,0,0,2449047,0,0,0,0);
INSERT INTO rank_stage VALUES(4,2,0,4218183,12023536,14023536,0,0,2,16,56);
INSERT INTO rank_stage VALUES(4,2,1,2063636,36706080,42564864,39425856,0,6,480,108);
INSERT INTO rank_stage VALUES(4,2,2,3818182,12141216,28282432,0,0,2,96,199);
INSERT INTO rank_stage VALUES(4,2,3,5863636,24282432,14141216,31914286,0,4,192,306);
INSERT INTO rank_stage VALUES(4,2,4,14804545,12023536,14023536,83501,0,2,16,806);
INSERT INTO rank_stage VALUES(4,2,5,28363635,31647520,36353320,6658812,0,5,1120,1450);
INSERT INTO rank_stage VALUES(4,2,6,909091,6058840,7058840,5543163,0,1,40,50);
INSERT INTO rank_stage VALUES(4,3,0,2890910,6011768,7011768,11000000,0,1,8,38);
INSERT INTO rank_stage VALUES(4,3,1,436364,12282432,28282432,86998919,0,2,192,24);
INSERT INTO rank_stage VALUES(4,3,2,2190910,0,28282432,16387602,0,0,0,115);
INSERT INTO rank_stage VALUES(4,3,3,4018182,24282432,0,30281960,0,4,192,210);
INSERT INTO rank_stage VALUES(4,3,4,9972727,6011768,7011768,26742798,0,1,8,543);
INSERT INTO rank_stage VALUES(4,3,5,18163635,18764920,21823760,49027056,0,3,520,900);
INSERT INTO rank_stage VALUES(4,3,6,600000,6058840,0,0,0,1,40,33);
INSERT INTO rank_stage VALUES(4,3,7,0,0,0,10462047,0,0,0,0);
INSERT INTO rank_stage VALUES(5,0,0,4218183,6011768,7011768,3000000,0,1,8,56);
INSERT INTO rank_stage VALUES(5,0,1,5645454,24282432,28564864,48317715,0,4,192,294);
INSERT INTO rank_stage VALUES(5,0,2,5872726,24282432,0,0,0,4,192,301);
INSERT INTO rank_stage VALUES(5,0,3,7709090,0,28282432,49926616,0,0,0,402);
INSERT INTO rank_stage VALUES(5,0,4,4959091,6011768,7011768,4467809,0,1,8,270);
INSERT INTO rank_stage VALUES(5,0,5,18163635,18529560,22059120,41060012,0,3,360,900);
INSERT INTO rank_stage VALUES(5,0,6,600000,0,7058840,19305912,0,0,0,33);
INSERT INTO rank_stage VALUES(5,1,0,4218183,12023536,14023536,0,0,2,16,56);
INSERT INTO rank_stage VALUES(5,1,1,1845454,36706080,28423648,3494067,0,6,480,96);
INSERT INTO rank_stage VALUES(5,1,2,3600000,12141216,14141216,33416606,0,2,96,187);
INSERT INTO rank_stage VALUES(5,1,3,5863636,12141216,14141216,38768225,0,2,96,306);
INSERT INTO rank_stage VALUES(5,1,4,14804545,12023536,14023536,0,0,2,16,806);
INSERT INTO rank_stage VALUES(5,1,5,22304545,25412160,28823760,23201282,0,4,960,1125);
INSERT INTO rank_stage VALUES(5,1,6,909091,6058840,7058840,0,0,1,40,50);
INSERT INTO rank_stage VALUES(5,1,7,0,0,0,2785025,0,0,0,0);
INSERT INTO rank_stage VALUES(5,2,0,2890910,6011768,7011768,11000000,0,1,8,38);
INSERT INTO rank_stage VALUES(5,2,1,436364,12282432,28282432,79851198,0,2,192,24);
INSERT INTO rank_stage VALUES(5,2,2,2190910,0,28282432,2148618,0,0,0,115);
INSERT INTO rank_stage VALUES(5,2,3,4018182,24282432,0,21218017,0,4,192,210);
INSERT INTO rank_stage VALUES(5,2,4,9972727,6011768,7011768,20672190,0,1,8,543);
INSERT INTO rank_stage VALUES(5,2,5,18163635,18764920,21823760,37567063,0,3,520,900);
INSERT INTO rank_stage VALUES(5,2,6,600000,6058840,0,0,0,1,40,33);
INSERT INTO rank_stage VALUES(5,2,7,0,0,0,15798861,0,0,0,0);
INSERT INTO rank_stage VALUES(6,0,0,4102165,6011768,7011768,3008404,0,1,8,56);
INSERT INTO rank_stage VALUES(6,0,1,1525427,12141216,14282432,17665287,0,2,96,84);
INSERT INTO rank_stage VALUES(6,0,2,4244848,12141216,0,0,0,2,96,217);
INSERT INTO rank_stage VALUES(6,0,3,5719671,0,14141216,47221282,0,0,0,306);
INSERT INTO rank_stage VALUES(6,0,4,4831303,6011768,7011768,0,0,1,8,270);
INSERT INTO rank_stage VALUES(6,0,5,9708577,12294200,14529560,12828836,0,2,200,500);
INSERT INTO rank_stage VALUES(6,0,6,577673,0,7058840,19134034,0,0,0,33);
INSERT INTO rank_stage VALUES(6,1,0,2984190,6011768,7011768,2991596,0,1,8,38);
INSERT INTO rank_stage VALUES(6,1,1,218641,12282432,14141216,40702003,0,2,192,12);
INSERT INTO rank_stage VALUES(6,1,2,2008192,0,14141216,239408,0,0,0,103);
INSERT INTO rank_stage VALUES(6,1,3,4150777,12141216,0,19130565,0,2,96,210);
INSERT INTO rank_stage VALUES(6,1,4,9924334,6011768,7011768,8938621,0,1,8,543);
INSERT INTO rank_stage VALUES(6,1,5,10231547,12529560,14294200,19317004,0,2,360,500);
INSERT INTO rank_stage VALUES(6,1,6,598890,6058840,0,0,0,1,40,33);
INSERT INTO rank_stage VALUES(6,1,7,0,0,0,10131739,0,0,0,0);
CREATE TABLE baseline (
    run_id       INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    ordinal      INTEGER NOT NULL,
    name         TEXT NOT NULL,
    time_ps      INTEGER NOT NULL,
    flops        INTEGER NOT NULL,
    divisions    INTEGER NOT NULL,
    square_roots INTEGER NOT NULL,
    sines        INTEGER NOT NULL,
    copied_bytes INTEGER NOT NULL,
    calls        INTEGER NOT NULL,
    PRIMARY KEY (run_id, ordinal)
) STRICT, WITHOUT ROWID;
INSERT INTO baseline VALUES(1,0,'parallel code on one processor',61701515,2905,20,0,10,0,47);
INSERT INTO baseline VALUES(1,1,'rnea',9190909,390,0,0,4,0,2);
INSERT INTO baseline VALUES(1,2,'rnea+aba',28516970,1329,2,0,8,0,4);
INSERT INTO baseline VALUES(1,3,'rnea+crba',26977273,1085,5,2,12,0,6);
INSERT INTO baseline VALUES(1,4,'rnea+cfa-paper',50698485,2496,10,0,8,0,11);
INSERT INTO baseline VALUES(1,5,'rnea+cfa-direct',48780303,2396,10,0,8,0,9);
INSERT INTO baseline VALUES(1,6,'fastest serial',26977273,1085,5,2,12,0,6);
INSERT INTO baseline VALUES(2,0,'parallel code on one processor',212577273,10435,60,0,22,0,145);
INSERT INTO baseline VALUES(2,1,'rnea',19254545,828,0,0,8,0,4);
INSERT INTO baseline VALUES(2,2,'rnea+aba',64179394,3051,4,0,16,0,8);
INSERT INTO baseline VALUES(2,3,'rnea+crba',61606667,2574,14,4,24,0,12);
INSERT INTO baseline VALUES(2,4,'rnea+cfa-paper',117483333,5874,20,0,16,0,23);
INSERT INTO baseline VALUES(2,5,'rnea+cfa-direct',113646970,5674,20,0,16,0,19);
INSERT INTO baseline VALUES(2,6,'fastest serial',61606667,2574,14,4,24,0,12);
INSERT INTO baseline VALUES(3,0,'parallel code on one processor',61701515,2905,20,0,10,0,47);
INSERT INTO baseline VALUES(3,1,'rnea',9190909,390,0,0,4,0,2);
INSERT INTO baseline VALUES(3,2,'rnea+aba',28516970,1329,2,0,8,0,4);
INSERT INTO baseline VALUES(3,3,'rnea+crba',26977273,1085,5,2,12,0,6);
INSERT INTO baseline VALUES(3,4,'rnea+cfa-paper',50698485,2496,10,0,8,0,11);
INSERT INTO baseline VALUES(3,5,'rnea+cfa-direct',48780303,2396,10,0,8,0,9);
INSERT INTO baseline VALUES(3,6,'fastest serial',26977273,1085,5,2,12,0,6);
INSERT INTO baseline VALUES(4,0,'parallel code on one processor',212577273,10435,60,0,22,0,145);
INSERT INTO baseline VALUES(4,1,'rnea',19254545,828,0,0,8,0,4);
INSERT INTO baseline VALUES(4,2,'rnea+aba',64179394,3051,4,0,16,0,8);
INSERT INTO baseline VALUES(4,3,'rnea+crba',61606667,2574,14,4,24,0,12);
INSERT INTO baseline VALUES(4,4,'rnea+cfa-paper',117483333,5874,20,0,16,0,23);
INSERT INTO baseline VALUES(4,5,'rnea+cfa-direct',113646970,5674,20,0,16,0,19);
INSERT INTO baseline VALUES(4,6,'fastest serial',61606667,2574,14,4,24,0,12);
INSERT INTO baseline VALUES(5,0,'parallel code on one processor',138986364,6745,45,0,16,0,98);
INSERT INTO baseline VALUES(5,1,'rnea',14222727,609,0,0,6,0,3);
INSERT INTO baseline VALUES(5,2,'rnea+aba',46348182,2190,3,0,12,0,6);
INSERT INTO baseline VALUES(5,3,'rnea+crba',44062727,1819,9,3,18,0,9);
INSERT INTO baseline VALUES(5,4,'rnea+cfa-paper',84090909,4185,15,0,12,0,17);
INSERT INTO baseline VALUES(5,5,'rnea+cfa-direct',81213636,4035,15,0,12,0,14);
INSERT INTO baseline VALUES(5,6,'fastest serial',44062727,1819,9,3,18,0,9);
INSERT INTO baseline VALUES(6,0,'parallel code on one processor',61701515,2905,20,0,10,0,47);
INSERT INTO baseline VALUES(6,1,'rnea',9190909,390,0,0,4,0,2);
INSERT INTO baseline VALUES(6,2,'rnea+aba',28516970,1329,2,0,8,0,4);
INSERT INTO baseline VALUES(6,3,'rnea+crba',26977273,1085,5,2,12,0,6);
INSERT INTO baseline VALUES(6,4,'rnea+cfa-paper',50698485,2496,10,0,8,0,11);
INSERT INTO baseline VALUES(6,5,'rnea+cfa-direct',48780303,2396,10,0,8,0,9);
INSERT INTO baseline VALUES(6,6,'fastest serial',26977273,1085,5,2,12,0,6);
CREATE TABLE error_check (
    run_id         INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    ordinal        INTEGER NOT NULL,
    quantity       TEXT NOT NULL,
    reference      TEXT NOT NULL,
    relative_error REAL,
    tolerance      REAL,
    passed         INTEGER NOT NULL CHECK (passed IN (0, 1)),
    PRIMARY KEY (run_id, ordinal)
) STRICT, WITHOUT ROWID;
INSERT INTO error_check VALUES(1,0,'tau','rnea',0.0,9.9999999999999993945e-12,1);
INSERT INTO error_check VALUES(1,1,'qdd','aba',9.0587512519802748664e-15,1.0000000000000000209e-08,1);
INSERT INTO error_check VALUES(2,0,'tau','rnea',1.9851541650598337314e-16,9.9999999999999993945e-12,1);
INSERT INTO error_check VALUES(2,1,'qdd','aba',3.1238902142401807611e-13,1.0000000000000000209e-08,1);
INSERT INTO error_check VALUES(3,0,'tau','rnea',0.0,9.9999999999999993945e-12,1);
INSERT INTO error_check VALUES(3,1,'qdd','aba',9.0587512519802748664e-15,1.0000000000000000209e-08,1);
INSERT INTO error_check VALUES(4,0,'tau','rnea',1.9851541650598337314e-16,9.9999999999999993945e-12,1);
INSERT INTO error_check VALUES(4,1,'qdd','aba',3.1238902142401807611e-13,1.0000000000000000209e-08,1);
INSERT INTO error_check VALUES(5,0,'tau','rnea',2.0850764942258289587e-16,9.9999999999999993945e-12,1);
INSERT INTO error_check VALUES(5,1,'qdd','aba',5.7144936995522675748e-14,1.0000000000000000209e-08,1);
INSERT INTO error_check VALUES(6,0,'tau','rnea',0.0,9.9999999999999993945e-12,1);
INSERT INTO error_check VALUES(6,1,'qdd','aba',9.0587512519802748664e-15,1.0000000000000000209e-08,1);
CREATE TABLE link_load (
    run_id      INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    link        INTEGER NOT NULL,
    from_router INTEGER,
    to_router   INTEGER,
    node        INTEGER,
    messages    INTEGER NOT NULL,
    sent_bytes  INTEGER NOT NULL,
    busy_ps     INTEGER NOT NULL,
    queue_ps    INTEGER NOT NULL,
    PRIMARY KEY (run_id, link)
) STRICT, WITHOUT ROWID;
CREATE TABLE span (
    run_id   INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    span     INTEGER NOT NULL,
    rank     INTEGER NOT NULL,
    stage    INTEGER NOT NULL,
    kind     TEXT NOT NULL CHECK (kind IN ('compute', 'send', 'recv', 'wait', 'barrier')),
    begin_ps INTEGER NOT NULL,
    end_ps   INTEGER NOT NULL,
    peer     INTEGER,
    bytes    INTEGER NOT NULL,
    message  INTEGER,
    PRIMARY KEY (run_id, span)
) STRICT, WITHOUT ROWID;
CREATE TABLE trace (
    run_id         INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    path           TEXT NOT NULL,
    format         TEXT NOT NULL,
    sha256         TEXT NOT NULL,
    size_bytes     INTEGER NOT NULL,
    spans          INTEGER NOT NULL,
    spans_left_out INTEGER NOT NULL,
    PRIMARY KEY (run_id, path)
) STRICT, WITHOUT ROWID;
CREATE TABLE check_point (
    id             INTEGER PRIMARY KEY,
    suite          TEXT NOT NULL,
    subject        TEXT NOT NULL,
    quantity       TEXT NOT NULL,
    at             TEXT NOT NULL,
    unit           TEXT NOT NULL,
    reference      REAL,
    value          REAL,
    relative_error REAL,
    tolerance      REAL,
    class          TEXT NOT NULL,
    verdict        TEXT NOT NULL CHECK (verdict IN ('pass', 'fail', 'not-testable')),
    source         TEXT NOT NULL,
    UNIQUE (suite, subject, quantity, at)
) STRICT;
CREATE TABLE claim (
    id         TEXT NOT NULL,
    variant    TEXT NOT NULL,
    statement  TEXT NOT NULL,
    test       TEXT NOT NULL,
    unit       TEXT NOT NULL,
    value      REAL,
    threshold  REAL,
    value_low  REAL,
    value_high REAL,
    samples    INTEGER NOT NULL DEFAULT 0,
    share      REAL,
    verdict    TEXT NOT NULL CHECK (verdict IN ('pass', 'fail', 'not-testable')),
    note       TEXT NOT NULL DEFAULT '',
    PRIMARY KEY (id, variant)
) STRICT, WITHOUT ROWID;
CREATE TABLE claim_sample (
    id      TEXT NOT NULL,
    variant TEXT NOT NULL,
    sample  INTEGER NOT NULL,
    value   REAL,
    holds   INTEGER CHECK (holds IN (0, 1)),
    PRIMARY KEY (id, variant, sample)
) STRICT, WITHOUT ROWID;
CREATE TABLE sample_setting (
    sample INTEGER NOT NULL,
    key    TEXT NOT NULL,
    value  REAL,
    PRIMARY KEY (sample, key)
) STRICT, WITHOUT ROWID;
CREATE TABLE ladder (
    scenario       TEXT NOT NULL,
    ladder         TEXT NOT NULL,
    at             TEXT NOT NULL,
    family         TEXT NOT NULL,
    method         TEXT NOT NULL,
    rung           TEXT NOT NULL,
    ordinal        INTEGER NOT NULL,
    quantity       TEXT NOT NULL,
    reference      TEXT NOT NULL,
    relative_error REAL,
    host_s         REAL,
    machine_ps     INTEGER,
    status         TEXT NOT NULL CHECK (status IN ('ok', 'degraded', 'failed')),
    text           TEXT NOT NULL DEFAULT '',
    PRIMARY KEY (scenario, ladder, family, at, method, rung, quantity)
) STRICT, WITHOUT ROWID;
INSERT INTO ladder VALUES('small','network','n=P=3','89d508caeca9a1dce53ac3dfbf9819a2b96820f44bb40f4cd752876f7c3fe5a9','auto','auto',11,'finish times','flit',0.0,0.00010455599931447068229,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','89d508caeca9a1dce53ac3dfbf9819a2b96820f44bb40f4cd752876f7c3fe5a9','auto','auto',10,'makespan','flit',0.0,0.00010455599931447068229,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','89d508caeca9a1dce53ac3dfbf9819a2b96820f44bb40f4cd752876f7c3fe5a9','closed form','closed form',1,'finish times','flit',0.26681714510679344076,2.244000825157854706e-06,287666489,'ok','mean work and messages of a rank, no overlap');
INSERT INTO ladder VALUES('small','network','n=P=3','89d508caeca9a1dce53ac3dfbf9819a2b96820f44bb40f4cd752876f7c3fe5a9','closed form','closed form',0,'makespan','flit',0.26681714510679344076,2.244000825157854706e-06,287666489,'ok','mean work and messages of a rank, no overlap');
INSERT INTO ladder VALUES('small','network','n=P=3','89d508caeca9a1dce53ac3dfbf9819a2b96820f44bb40f4cd752876f7c3fe5a9','flit','flit',9,'finish times','flit',0.0,0.00024840100013534538447,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','89d508caeca9a1dce53ac3dfbf9819a2b96820f44bb40f4cd752876f7c3fe5a9','flit','flit',8,'makespan','flit',0.0,0.00024840100013534538447,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','89d508caeca9a1dce53ac3dfbf9819a2b96820f44bb40f4cd752876f7c3fe5a9','link','link',5,'finish times','flit',0.0,7.5793000178236979991e-05,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','89d508caeca9a1dce53ac3dfbf9819a2b96820f44bb40f4cd752876f7c3fe5a9','link','link',4,'makespan','flit',0.0,7.5793000178236979991e-05,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','89d508caeca9a1dce53ac3dfbf9819a2b96820f44bb40f4cd752876f7c3fe5a9','loggp','loggp',3,'finish times','flit',0.0,5.7025000387511681765e-05,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','89d508caeca9a1dce53ac3dfbf9819a2b96820f44bb40f4cd752876f7c3fe5a9','loggp','loggp',2,'makespan','flit',0.0,5.7025000387511681765e-05,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','89d508caeca9a1dce53ac3dfbf9819a2b96820f44bb40f4cd752876f7c3fe5a9','packet','packet',7,'finish times','flit',0.0,0.00011803599954873789101,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','89d508caeca9a1dce53ac3dfbf9819a2b96820f44bb40f4cd752876f7c3fe5a9','packet','packet',6,'makespan','flit',0.0,0.00011803599954873789101,392352995,'ok','');
CREATE TABLE ladder_choice (
    scenario       TEXT NOT NULL,
    ladder         TEXT NOT NULL,
    at             TEXT NOT NULL,
    quantity       TEXT NOT NULL,
    tolerance      REAL NOT NULL,
    method         TEXT,
    rung           TEXT,
    relative_error REAL,
    cost_ratio     REAL,
    PRIMARY KEY (scenario, ladder, at, quantity, tolerance)
) STRICT, WITHOUT ROWID;
CREATE TABLE stability (
    suite          TEXT NOT NULL,
    subject        TEXT NOT NULL,
    algorithm      TEXT NOT NULL,
    precision      TEXT NOT NULL,
    ordinal        INTEGER NOT NULL,
    status         TEXT NOT NULL CHECK (status IN ('ok', 'degraded', 'failed')),
    relative_error REAL,
    residual       REAL,
    condition      REAL,
    growth         REAL,
    refinements    INTEGER,
    energy_drift   REAL,
    step_s         REAL,
    reason         TEXT NOT NULL,
    PRIMARY KEY (suite, subject, algorithm, precision)
) STRICT, WITHOUT ROWID;
CREATE TABLE run_omission (
    run_id INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    what   TEXT NOT NULL,
    why    TEXT NOT NULL,
    class  TEXT NOT NULL CHECK (class IN ('exact', 'bounded')),
    bound  REAL,
    PRIMARY KEY (run_id, what)
) STRICT, WITHOUT ROWID;
INSERT INTO run_omission VALUES(1,'angular base terms','the base does not turn','exact',NULL);
INSERT INTO run_omission VALUES(1,'branch and loop phases','an open chain has neither','bounded',2.0000000000000000418e-08);
INSERT INTO run_omission VALUES(1,'counters of single links','record.links does not ask for them','exact',NULL);
INSERT INTO run_omission VALUES(1,'events that start messages','eager sends are in order','exact',NULL);
INSERT INTO run_omission VALUES(1,'external forces','no body has any','exact',NULL);
INSERT INTO run_omission VALUES(1,'general joints in the serial references','all joints are revolute','exact',NULL);
INSERT INTO run_omission VALUES(1,'scene and serial answers of other runs','runs of one scene share them','exact',NULL);
INSERT INTO run_omission VALUES(1,'timeline','record.spans does not ask for it','exact',NULL);
INSERT INTO run_omission VALUES(2,'angular base terms','the base does not turn','exact',NULL);
INSERT INTO run_omission VALUES(2,'branch and loop phases','an open chain has neither','bounded',2.0000000000000000418e-08);
INSERT INTO run_omission VALUES(2,'counters of single links','record.links does not ask for them','exact',NULL);
INSERT INTO run_omission VALUES(2,'events that start messages','eager sends are in order','exact',NULL);
INSERT INTO run_omission VALUES(2,'external forces','no body has any','exact',NULL);
INSERT INTO run_omission VALUES(2,'general joints in the serial references','all joints are revolute','exact',NULL);
INSERT INTO run_omission VALUES(2,'scene and serial answers of other runs','runs of one scene share them','exact',NULL);
INSERT INTO run_omission VALUES(2,'timeline','record.spans does not ask for it','exact',NULL);
INSERT INTO run_omission VALUES(3,'angular base terms','the base does not turn','exact',NULL);
INSERT INTO run_omission VALUES(3,'branch and loop phases','an open chain has neither','bounded',2.0000000000000000418e-08);
INSERT INTO run_omission VALUES(3,'counters of single links','record.links does not ask for them','exact',NULL);
INSERT INTO run_omission VALUES(3,'external forces','no body has any','exact',NULL);
INSERT INTO run_omission VALUES(3,'general joints in the serial references','all joints are revolute','exact',NULL);
INSERT INTO run_omission VALUES(3,'scene and serial answers of other runs','runs of one scene share them','exact',NULL);
INSERT INTO run_omission VALUES(3,'timeline','record.spans does not ask for it','exact',NULL);
INSERT INTO run_omission VALUES(4,'angular base terms','the base does not turn','exact',NULL);
INSERT INTO run_omission VALUES(4,'branch and loop phases','an open chain has neither','bounded',2.0000000000000000418e-08);
INSERT INTO run_omission VALUES(4,'counters of single links','record.links does not ask for them','exact',NULL);
INSERT INTO run_omission VALUES(4,'external forces','no body has any','exact',NULL);
INSERT INTO run_omission VALUES(4,'general joints in the serial references','all joints are revolute','exact',NULL);
INSERT INTO run_omission VALUES(4,'scene and serial answers of other runs','runs of one scene share them','exact',NULL);
INSERT INTO run_omission VALUES(4,'timeline','record.spans does not ask for it','exact',NULL);
INSERT INTO run_omission VALUES(5,'angular base terms','the base does not turn','exact',NULL);
INSERT INTO run_omission VALUES(5,'branch and loop phases','an open chain has neither','bounded',2.0000000000000000418e-08);
INSERT INTO run_omission VALUES(5,'counters of single links','record.links does not ask for them','exact',NULL);
INSERT INTO run_omission VALUES(5,'external forces','no body has any','exact',NULL);
INSERT INTO run_omission VALUES(5,'general joints in the serial references','all joints are revolute','exact',NULL);
INSERT INTO run_omission VALUES(5,'scene and serial answers of other runs','runs of one scene share them','exact',NULL);
INSERT INTO run_omission VALUES(5,'timeline','record.spans does not ask for it','exact',NULL);
INSERT INTO run_omission VALUES(6,'angular base terms','the base does not turn','exact',NULL);
INSERT INTO run_omission VALUES(6,'branch and loop phases','an open chain has neither','bounded',2.0000000000000000418e-08);
INSERT INTO run_omission VALUES(6,'counters of single links','record.links does not ask for them','exact',NULL);
INSERT INTO run_omission VALUES(6,'events that start messages','eager sends are in order','exact',NULL);
INSERT INTO run_omission VALUES(6,'external forces','no body has any','exact',NULL);
INSERT INTO run_omission VALUES(6,'general joints in the serial references','all joints are revolute','exact',NULL);
INSERT INTO run_omission VALUES(6,'scene and serial answers of other runs','runs of one scene share them','exact',NULL);
INSERT INTO run_omission VALUES(6,'timeline','record.spans does not ask for it','exact',NULL);
CREATE TABLE omission (
    scenario         TEXT NOT NULL,
    what             TEXT NOT NULL,
    ordinal          INTEGER NOT NULL,
    why              TEXT NOT NULL,
    class            TEXT NOT NULL CHECK (class IN ('exact', 'bounded')),
    bound            REAL,
    at               TEXT NOT NULL,
    host_s           REAL,
    host_saved_s     REAL,
    host_noise_s     REAL,
    machine_ps       INTEGER,
    machine_saved_ps INTEGER,
    PRIMARY KEY (scenario, what)
) STRICT, WITHOUT ROWID;
CREATE INDEX run_by_point ON run (machine, kernel, n, P);
CREATE VIEW v_speedup AS
SELECT r.id AS run_id, r.scenario, r.machine, r.topology, r.level, r.kernel, r.formulation, r.solver, r.part_solver,
       r.operators, r.precision, r.base, r.n, r.P, r.compute_noise_cv, r.background_load, r.seed, r.rep,
       b.ordinal AS baseline_ordinal, b.name AS baseline, b.time_ps AS baseline_ps, r.makespan_ps,
       CAST(b.time_ps AS REAL) / nullif(r.makespan_ps, 0) AS speedup,
       CAST(b.time_ps AS REAL) / nullif(r.makespan_ps, 0) / r.P AS efficiency,
       CASE WHEN r.P > 1 AND b.time_ps > 0
            THEN (1.0 - CAST(r.makespan_ps AS REAL) / b.time_ps) / (1.0 - 1.0 / r.P) END AS parallel_fraction
FROM run r JOIN baseline b ON b.run_id = r.id
WHERE r.status = 'ok';
CREATE VIEW v_stage AS
SELECT r.id AS run_id, r.scenario, r.machine, r.level, r.kernel, r.formulation, r.solver, r.operators, r.n, r.P,
       s.stage, s.name, s.total_max_ps,
       s.total_sum_ps      / (1.0 * r.P) AS total_mean_ps,
       s.compute_sum_ps    / (1.0 * r.P) AS compute_mean_ps,    s.compute_max_ps,
       s.send_sum_ps       / (1.0 * r.P) AS send_mean_ps,       s.send_max_ps,
       s.recv_sum_ps       / (1.0 * r.P) AS recv_mean_ps,       s.recv_max_ps,
       s.wait_sum_ps       / (1.0 * r.P) AS wait_mean_ps,       s.wait_max_ps,
       s.contention_sum_ps / (1.0 * r.P) AS contention_mean_ps, s.contention_max_ps,
       s.messages, s.sent_bytes, s.flops
FROM run r JOIN stage s ON s.run_id = r.id
WHERE r.status = 'ok';
CREATE VIEW v_link_top AS
SELECT run_id, scenario, machine, topology, level, kernel, n, P, place, link, from_router, to_router, node, messages,
       sent_bytes, busy_ps, busy_share, queue_ps
FROM (SELECT r.id AS run_id, r.scenario, r.machine, r.topology, r.level, r.kernel, r.n, r.P, l.link, l.from_router,
             l.to_router, l.node, l.messages, l.sent_bytes, l.busy_ps,
             1.0 * l.busy_ps / nullif(r.makespan_ps, 0) AS busy_share, l.queue_ps,
             row_number() OVER (PARTITION BY r.id ORDER BY l.busy_ps DESC, l.queue_ps DESC, l.link) AS place
      FROM link_load l JOIN run r ON r.id = l.run_id)
WHERE place <= 10;
CREATE VIEW v_accounting AS
SELECT r.id AS run_id, r.scenario, r.n, r.P, r.makespan_ps, r.P * r.makespan_ps AS expected_ps,
       sum(s.compute_sum_ps + s.send_sum_ps + s.recv_sum_ps + s.wait_sum_ps + s.contention_sum_ps) AS found_ps,
       sum(s.compute_sum_ps + s.send_sum_ps + s.recv_sum_ps + s.wait_sum_ps + s.contention_sum_ps)
           - r.P * r.makespan_ps AS difference_ps,
       r.accounting_error_ps
FROM run r JOIN stage s ON s.run_id = r.id
WHERE r.status IN ('ok', 'invalid')
GROUP BY r.id;
CREATE VIEW v_errors AS
SELECT r.id AS run_id, r.scenario, r.machine, r.kernel, r.formulation, r.solver, r.precision, r.n, r.P, r.status,
       e.quantity, e.reference, e.relative_error, e.tolerance, e.passed
FROM run r JOIN error_check e ON e.run_id = r.id;
CREATE VIEW v_indicator AS
SELECT r.id AS run_id, r.scenario, r.machine, r.level, r.kernel, r.formulation, r.operators, r.n, r.P, r.makespan_ps,
       1.0 * r.P * r.makespan_ps
           / nullif(sum(s.send_sum_ps + s.recv_sum_ps + s.wait_sum_ps + s.contention_sum_ps), 0) AS rc_ratio,
       1.0 * sum(s.compute_sum_ps) / nullif(r.P * r.makespan_ps, 0) AS compute_share,
       1.0 * sum(s.send_sum_ps + s.recv_sum_ps) / nullif(r.P * r.makespan_ps, 0) AS overhead_share,
       1.0 * sum(s.wait_sum_ps) / nullif(r.P * r.makespan_ps, 0) AS wait_share,
       1.0 * sum(s.contention_sum_ps) / nullif(r.P * r.makespan_ps, 0) AS contention_share,
       1.0 * (r.rank_compute_max_ps - r.rank_compute_min_ps) * r.P / nullif(sum(s.compute_sum_ps), 0) AS load_spread
FROM run r JOIN stage s ON s.run_id = r.id
WHERE r.status = 'ok'
GROUP BY r.id;
CREATE VIEW v_repetition AS
WITH spread AS (
    SELECT min(id) AS run_id, config_hash, scenario, machine, level, kernel, formulation, n, P, count(*) AS repetitions,
           avg(makespan_ps) AS mean_ps, min(makespan_ps) AS min_ps, max(makespan_ps) AS max_ps,
           CASE WHEN count(*) > 1
                THEN sqrt(max(0.0, avg(1.0 * makespan_ps * makespan_ps) - avg(makespan_ps) * avg(makespan_ps))
                          * count(*) / (count(*) - 1.0)) END AS deviation_ps
    FROM run WHERE status = 'ok' GROUP BY config_hash)
SELECT *, deviation_ps / sqrt(repetitions)
           * CASE repetitions WHEN 2 THEN 12.706 WHEN 3 THEN 4.303 WHEN 4 THEN 3.182 WHEN 5 THEN 2.776 WHEN 6 THEN 2.571
                              WHEN 7 THEN 2.447 WHEN 8 THEN 2.365 WHEN 9 THEN 2.306 WHEN 10 THEN 2.262
                              ELSE 1.96 + 2.5 / (repetitions - 1) END AS confidence95_ps
FROM spread;
CREATE VIEW v_setting AS
SELECT rs.run_id, s.key, s.value FROM run_setting rs JOIN setting s ON s.id = rs.setting_id;
CREATE VIEW v_itervar AS
WITH varied AS (
    SELECT r.scenario, s.key
    FROM run_setting rs JOIN run r ON r.id = rs.run_id JOIN setting s ON s.id = rs.setting_id
    GROUP BY r.scenario, s.key HAVING count(DISTINCT s.id) > 1)
SELECT rs.run_id, r.scenario, s.key, s.value
FROM run_setting rs JOIN run r ON r.id = rs.run_id JOIN setting s ON s.id = rs.setting_id
     JOIN varied v ON v.scenario = r.scenario AND v.key = s.key;
CREATE VIEW v_claims AS
SELECT id, variant, statement, verdict, value, unit, threshold, value_low, value_high, share, samples, note
FROM claim;
CREATE VIEW v_provenance AS
SELECT r.id AS run_id, r.scenario, r.config_hash, r.seed, r.rep, r.digest, r.status, r.created_utc, b.version, b.git,
       b.compiler, b.flags, r.host_s, r.host_total_s, r.host_peak_bytes, r.left_out
FROM run r JOIN build b ON b.id = r.build_id;
COMMIT;
PRAGMA application_id = 1835625828;
PRAGMA user_version = 4;
