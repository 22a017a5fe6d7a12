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
INSERT INTO build VALUES(1,'0.1.0','b99e5053b5b4','gcc 12.2.0','-O2 -g');
CREATE TABLE run (
    id               INTEGER PRIMARY KEY,
    config_hash TEXT NOT NULL, -- SHA-256 that identifies its settings
    seed INTEGER NOT NULL, -- of noise, background traffic and random routes
    rep INTEGER NOT NULL, -- repetition, from 0
    scenario TEXT NOT NULL, -- the scenario's file without its folder and ending
    machine TEXT NOT NULL, -- name of the machine
    topology TEXT NOT NULL, -- family of its network
    level TEXT NOT NULL, -- how closely the network is simulated
    placement TEXT NOT NULL, -- of ranks on nodes
    kernel TEXT NOT NULL, -- the parallel program
    formulation TEXT NOT NULL, -- of forward dynamics
    solver TEXT NOT NULL, -- of the system of all ranks
    part_solver TEXT NOT NULL, -- of a rank's own part of it
    operators TEXT NOT NULL, -- how the matrices of a body are built and counted
    precision TEXT NOT NULL, -- of all numbers
    model TEXT NOT NULL, -- where the multibody system comes from
    base TEXT NOT NULL, -- how its first body is held
    joint TEXT NOT NULL, -- type of its joints
    n INTEGER NOT NULL, -- bodies
    nu INTEGER NOT NULL, -- degrees of freedom, 0 when there is no model
    P INTEGER NOT NULL, -- virtual processors
    compute_noise_cv REAL, -- relative deviation of computing times; 0: no noise
    background_load REAL, -- share of the links that other jobs use; 0: none
    status TEXT NOT NULL CHECK (status IN ('ok', 'invalid', 'deadlock', 'failed')), -- how it ended
    text TEXT NOT NULL, -- why it is not ok
    makespan_ps INTEGER NOT NULL, -- when the last rank ended, simulated time
    measured_s REAL, -- what a micro-benchmark's kernel measured, simulated time
    loop_rows INTEGER, -- constraints of closed chains; NULL: no loops
    loop_rank INTEGER, -- independent ones among them: fewer than loop_rows are redundant
    drift_position REAL, -- largest violation of a loop when the run ends, in the model's units
    drift_velocity REAL, -- largest velocity of such a violation, in the model's units
    residual REAL, -- largest relative residual of the constraints, as the kernel sees it
    condition REAL, -- lower bound of the condition of the block-scaled system
    messages INTEGER NOT NULL, -- sent by all ranks
    sent_bytes INTEGER NOT NULL, -- in them
    events INTEGER NOT NULL, -- dispatched by the simulator
    ties INTEGER NOT NULL, -- events that shared their time with the one before
    switches INTEGER NOT NULL, -- from one rank's program to another's
    digest TEXT NOT NULL, -- of all messages and clocks: 16 hexadecimal digits
    accounting_error_ps INTEGER NOT NULL, -- largest |sum of all parts - makespan| over the ranks; 0 is exact
    finish_min_ps INTEGER, -- when the first rank ended
    finish_max_ps INTEGER, -- when the last rank ended
    rank_compute_min_ps INTEGER, -- computing of the least loaded rank
    rank_compute_max_ps INTEGER, -- computing of the most loaded rank
    links INTEGER NOT NULL, -- link loads that were recorded, stored or not
    host_s REAL, -- wall time of the simulation proper
    host_total_s REAL, -- wall time with model, references and checks
    host_peak_bytes INTEGER, -- most memory that the run used on this computer
    stack_peak_bytes INTEGER, -- deepest stack of a rank
    level_asked TEXT, -- 'auto-tolerance 2 %': `level` was taken for its measured error
    level_error REAL, -- of the makespan, relative, at level_error_at
    level_error_at TEXT, -- where that was measured: "n=P=128"
    inner_added INTEGER NOT NULL, -- refinements inside a solution that were switched on because the first answer needed them
    outer_added INTEGER NOT NULL, -- refinements of whole solutions, likewise
    twice_added INTEGER NOT NULL, -- 1: the residual in twice the digits was switched on, too
    residual_before REAL, -- of that first answer; `residual` and all times are those with the refinements
    left_out TEXT NOT NULL, -- what it left out, with reasons: run_omission as text
    config_text TEXT NOT NULL, -- all settings as text; SHA-256 of it is config_hash
    machine_changes TEXT, -- JSON: settings that are not those of the shipped machine of this name; '{}': none; NULL: none is shipped
    machine_hash TEXT, -- SHA-256 of that shipped machine, as it was when the run was made
    build_id         INTEGER NOT NULL REFERENCES build (id),
    created_utc      TEXT NOT NULL,
    UNIQUE (config_hash, seed, rep)
) STRICT;
INSERT INTO run VALUES(1,'cb98187dbfe6bd207eabf1881fa77f14de29f27b3f8c7fa273401f43fdba58a7',1,0,'small','t3e-300','torus','link','linear','dynamics','paper','pcr-symmetric','pcr','structured','double','serial-chain','fixed','revolute',2,2,2,0.0,0.0,'ok','',244015762,NULL,NULL,NULL,NULL,NULL,4.6810875464771036051e-12,125.78295476027810196,17,1112,34,2,20,'42c369d40f061949',0,233862806,244015762,29930304,31771211,0,0.00010205200032942229881,0.0004420699997353949584,5619712,4096,NULL,NULL,NULL,0,0,0,NULL,'external forces: no body has any; angular base terms: the base does not turn; scene and serial answers of other runs: runs of one scene share them; branch and loop phases: an open chain has neither; general joints in the serial references: all joints are revolute; events that start messages: eager sends are in order; timeline: record.spans does not ask for it; counters of single links: record.links does not ask for them',replace('scenario = small\nranks = 2\nseed = 1\nrecord.baselines = all\nrecord.links = false\nrecord.spans = false\nmachine.name = t3e-300\nmachine.topology.family = torus\nmachine.topology.dims = [8, 4, 4]\nmachine.topology.dim_bandwidth = [0 B/s]\nmachine.topology.nodes_per_router = 1\nmachine.topology.processors_per_node = 1\nmachine.topology.tie = positive\nmachine.topology.routing = minimal\nmachine.topology.xpress = false\nmachine.topology.links = []\nmachine.topology.link_percent = []\nmachine.node.flop_rate = 55 Mflop/s\nmachine.node.serial_rate = 0 flop/s\nmachine.node.clock = 300 MHz\nmachine.node.div = 23 cycles\nmachine.node.sqrt = 85 cycles\nmachine.node.trig = 150 cycles\nmachine.node.call = 50 ns\nmachine.node.copy.bandwidth = 600 MB/s\nmachine.network.level = link\nmachine.network.tolerance = 2 %\nmachine.network.link.bandwidth = 480 MB/s\nmachine.network.injection.bandwidth = 340 MB/s\nmachine.network.ejection.bandwidth = 480 MB/s\nmachine.network.hop_latency = 60 ns\nmachine.network.end_latency = 2.88 us\nmachine.network.credit_latency = 27 ns\nmachine.network.flit = 8 B\nmachine.network.packet = 64 B\nmachine.network.header = 0 B\nmachine.network.virtual_channels = 2\nmachine.network.buffer = 22\nmachine.network.arbitration = round-robin\nmachine.software.send.overhead = 6 us\nmachine.software.send.copy = 1.471 ns/B\nmachine.software.recv.overhead = 7 us\nmachine.software.recv.copy = 1.471 ns/B\nmachine.software.gap = 8 us\nmachine.software.gap_per_byte = 0 s/B\nmachine.software.short.limit = 0 B\nmachine.software.short.saving = 0 s\nmachine.software.short.copy = 0 s/B\nmachine.software.eager.limit = 4 KiB\nmachine.software.eager.copy = 0 s/B\nmachine.software.rendezvous.latency = 0 s\nmachine.software.segments = []\nmachine.software.kernel.server = false\nmachine.software.kernel.time = 0 s\nmachine.software.kernel.per_byte = 0 s/B\nmachine.software.collectives = \nmachine.software.barrier.kind = hardware\nmachine.software.barrier.time = 8 us\nmachine.software.put.overhead = 0 s\nmachine.software.get.overhead = 0 s\nmachine.software.shared.latency = 0 s\nmachine.software.shared.bandwidth = 0 B/s\nmachine.placement.kind = linear\nmachine.placement.spread = block\nmachine.placement.seed = 1\nmachine.placement.list = []\nmachine.noise.compute = 0 %\nmachine.noise.background.load = 0 %\nmachine.noise.background.message = 1 KiB\nmodel.generator = serial-chain\nmodel.n = 2\nmodel.joint = revolute\nmodel.base = fixed\nmodel.inertia = uniform\nmodel.pose = random\nmodel.axes = twisted\nmodel.length = 1 m\nmodel.radius = 50 mm\nmodel.mass = 1 kg\nmodel.mass_ratio = 1\nmodel.gravity = [0 m/s^2, 0 m/s^2, -9.81 m/s^2]\nmodel.base_acceleration.angular = [0 rad/s^2, 0 rad/s^2, 0 rad/s^2]\nmodel.base_acceleration.linear = [0 m/s^2, 0 m/s^2, 0 m/s^2]\nmodel.rate = 1 rad/s\nmodel.torque = 1 N m\nmodel.external_force = 0 N\nmodel.stiffness = 0 N m/rad\nmodel.damping = 0 N m s/rad\nmodel.stabilisation = 0 rad/s\nmodel.branch = 2\nmodel.seed = 1\nmodel.path = \nkernel.name = dynamics\nkernel.formulation = paper\nkernel.solver = pcr-symmetric\nkernel.part_solver = pcr\nkernel.operators = structured\nkernel.algebra = auto\nkernel.precision = double\nkernel.partition = block\nkernel.composites_incoming = false\nkernel.hybrid_levels = 1\nkernel.refinement = as-needed\nkernel.residual = working\nkernel.inner_refinements = 0\nkernel.outer_refinements = 0\nkernel.steps = 0\nkernel.step_size = 1 ms\nkernel.step = semi-implicit\nkernel.repeat = 1\nkernel.message = 0 B\nkernel.distance = 1\nkernel.algorithm = auto\nkernel.root = 0\nkernel.ring_ranks = 0\n','\n',char(10)),'{}','35110217f2806a84e2e9cd19b4ad95d63f2fc713b8ea1471a21ccf6d89df0e7d',1,'2026-11-22T11:38:28Z');
INSERT INTO run VALUES(2,'916b46f670fee4a8e4a922f6c0d0df96cc84ac40a030f9031c99a60d73dbb67c',1,0,'small','t3e-300','torus','loggp','linear','dynamics','paper','pcr-symmetric','pcr','structured','double','serial-chain','fixed','revolute',3,3,3,0.0,0.0,'ok','',392352995,NULL,NULL,NULL,NULL,NULL,3.6570768836111345724e-11,335.71590182755289789,44,3424,0,0,28,'1743f305f277c979',0,376554134,392352995,38272728,53545454,0,0.000102203000096778851,0.00037736299964308273047,5632000,4096,'auto-tolerance 3 %',0.0,'n=P=3',0,0,0,NULL,'external forces: no body has any; angular base terms: the base does not turn; scene and serial answers of other runs: runs of one scene share them; branch and loop phases: an open chain has neither; general joints in the serial references: all joints are revolute; timeline: record.spans does not ask for it; counters of single links: record.links does not ask for them',replace('scenario = small\nranks = 3\nseed = 1\nrecord.baselines = all\nrecord.links = false\nrecord.spans = false\nmachine.name = t3e-300\nmachine.topology.family = torus\nmachine.topology.dims = [8, 4, 4]\nmachine.topology.dim_bandwidth = [0 B/s]\nmachine.topology.nodes_per_router = 1\nmachine.topology.processors_per_node = 1\nmachine.topology.tie = positive\nmachine.topology.routing = minimal\nmachine.topology.xpress = false\nmachine.topology.links = []\nmachine.topology.link_percent = []\nmachine.node.flop_rate = 55 Mflop/s\nmachine.node.serial_rate = 0 flop/s\nmachine.node.clock = 300 MHz\nmachine.node.div = 23 cycles\nmachine.node.sqrt = 85 cycles\nmachine.node.trig = 150 cycles\nmachine.node.call = 50 ns\nmachine.node.copy.bandwidth = 600 MB/s\nmachine.network.level = auto-tolerance\nmachine.network.tolerance = 3 %\nmachine.network.link.bandwidth = 480 MB/s\nmachine.network.injection.bandwidth = 340 MB/s\nmachine.network.ejection.bandwidth = 480 MB/s\nmachine.network.hop_latency = 60 ns\nmachine.network.end_latency = 2.88 us\nmachine.network.credit_latency = 27 ns\nmachine.network.flit = 8 B\nmachine.network.packet = 64 B\nmachine.network.header = 0 B\nmachine.network.virtual_channels = 2\nmachine.network.buffer = 22\nmachine.network.arbitration = round-robin\nmachine.software.send.overhead = 6 us\nmachine.software.send.copy = 1.471 ns/B\nmachine.software.recv.overhead = 7 us\nmachine.software.recv.copy = 1.471 ns/B\nmachine.software.gap = 8 us\nmachine.software.gap_per_byte = 0 s/B\nmachine.software.short.limit = 0 B\nmachine.software.short.saving = 0 s\nmachine.software.short.copy = 0 s/B\nmachine.software.eager.limit = 4 KiB\nmachine.software.eager.copy = 0 s/B\nmachine.software.rendezvous.latency = 0 s\nmachine.software.segments = []\nmachine.software.kernel.server = false\nmachine.software.kernel.time = 0 s\nmachine.software.kernel.per_byte = 0 s/B\nmachine.software.collectives = \nmachine.software.barrier.kind = hardware\nmachine.software.barrier.time = 8 us\nmachine.software.put.overhead = 0 s\nmachine.software.get.overhead = 0 s\nmachine.software.shared.latency = 0 s\nmachine.software.shared.bandwidth = 0 B/s\nmachine.placement.kind = linear\nmachine.placement.spread = block\nmachine.placement.seed = 1\nmachine.placement.list = []\nmachine.noise.compute = 0 %\nmachine.noise.background.load = 0 %\nmachine.noise.background.message = 1 KiB\nmodel.generator = serial-chain\nmodel.n = 3\nmodel.joint = revolute\nmodel.base = fixed\nmodel.inertia = uniform\nmodel.pose = random\nmodel.axes = twisted\nmodel.length = 1 m\nmodel.radius = 50 mm\nmodel.mass = 1 kg\nmodel.mass_ratio = 1\nmodel.gravity = [0 m/s^2, 0 m/s^2, -9.81 m/s^2]\nmodel.base_acceleration.angular = [0 rad/s^2, 0 rad/s^2, 0 rad/s^2]\nmodel.base_acceleration.linear = [0 m/s^2, 0 m/s^2, 0 m/s^2]\nmodel.rate = 1 rad/s\nmodel.torque = 1 N m\nmodel.external_force = 0 N\nmodel.stiffness = 0 N m/rad\nmodel.damping = 0 N m s/rad\nmodel.stabilisation = 0 rad/s\nmodel.branch = 2\nmodel.seed = 1\nmodel.path = \nkernel.name = dynamics\nkernel.formulation = paper\nkernel.solver = pcr-symmetric\nkernel.part_solver = pcr\nkernel.operators = structured\nkernel.algebra = auto\nkernel.precision = double\nkernel.partition = block\nkernel.composites_incoming = false\nkernel.hybrid_levels = 1\nkernel.refinement = as-needed\nkernel.residual = working\nkernel.inner_refinements = 0\nkernel.outer_refinements = 0\nkernel.steps = 0\nkernel.step_size = 1 ms\nkernel.step = semi-implicit\nkernel.repeat = 1\nkernel.message = 0 B\nkernel.distance = 1\nkernel.algorithm = auto\nkernel.root = 0\nkernel.ring_ranks = 0\n','\n',char(10)),'{}','35110217f2806a84e2e9cd19b4ad95d63f2fc713b8ea1471a21ccf6d89df0e7d',1,'2026-11-22T11:38:28Z');
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
INSERT INTO setting VALUES(19,'machine.node.serial_rate','0 flop/s');
INSERT INTO setting VALUES(20,'machine.node.clock','300 MHz');
INSERT INTO setting VALUES(21,'machine.node.div','23 cycles');
INSERT INTO setting VALUES(22,'machine.node.sqrt','85 cycles');
INSERT INTO setting VALUES(23,'machine.node.trig','150 cycles');
INSERT INTO setting VALUES(24,'machine.node.call','50 ns');
INSERT INTO setting VALUES(25,'machine.node.copy.bandwidth','600 MB/s');
INSERT INTO setting VALUES(26,'machine.network.level','link');
INSERT INTO setting VALUES(27,'machine.network.tolerance','2 %');
INSERT INTO setting VALUES(28,'machine.network.link.bandwidth','480 MB/s');
INSERT INTO setting VALUES(29,'machine.network.injection.bandwidth','340 MB/s');
INSERT INTO setting VALUES(30,'machine.network.ejection.bandwidth','480 MB/s');
INSERT INTO setting VALUES(31,'machine.network.hop_latency','60 ns');
INSERT INTO setting VALUES(32,'machine.network.end_latency','2.88 us');
INSERT INTO setting VALUES(33,'machine.network.credit_latency','27 ns');
INSERT INTO setting VALUES(34,'machine.network.flit','8 B');
INSERT INTO setting VALUES(35,'machine.network.packet','64 B');
INSERT INTO setting VALUES(36,'machine.network.header','0 B');
INSERT INTO setting VALUES(37,'machine.network.virtual_channels','2');
INSERT INTO setting VALUES(38,'machine.network.buffer','22');
INSERT INTO setting VALUES(39,'machine.network.arbitration','round-robin');
INSERT INTO setting VALUES(40,'machine.software.send.overhead','6 us');
INSERT INTO setting VALUES(41,'machine.software.send.copy','1.471 ns/B');
INSERT INTO setting VALUES(42,'machine.software.recv.overhead','7 us');
INSERT INTO setting VALUES(43,'machine.software.recv.copy','1.471 ns/B');
INSERT INTO setting VALUES(44,'machine.software.gap','8 us');
INSERT INTO setting VALUES(45,'machine.software.gap_per_byte','0 s/B');
INSERT INTO setting VALUES(46,'machine.software.short.limit','0 B');
INSERT INTO setting VALUES(47,'machine.software.short.saving','0 s');
INSERT INTO setting VALUES(48,'machine.software.short.copy','0 s/B');
INSERT INTO setting VALUES(49,'machine.software.eager.limit','4 KiB');
INSERT INTO setting VALUES(50,'machine.software.eager.copy','0 s/B');
INSERT INTO setting VALUES(51,'machine.software.rendezvous.latency','0 s');
INSERT INTO setting VALUES(52,'machine.software.segments','[]');
INSERT INTO setting VALUES(53,'machine.software.kernel.server','false');
INSERT INTO setting VALUES(54,'machine.software.kernel.time','0 s');
INSERT INTO setting VALUES(55,'machine.software.kernel.per_byte','0 s/B');
INSERT INTO setting VALUES(56,'machine.software.collectives','');
INSERT INTO setting VALUES(57,'machine.software.barrier.kind','hardware');
INSERT INTO setting VALUES(58,'machine.software.barrier.time','8 us');
INSERT INTO setting VALUES(59,'machine.software.put.overhead','0 s');
INSERT INTO setting VALUES(60,'machine.software.get.overhead','0 s');
INSERT INTO setting VALUES(61,'machine.software.shared.latency','0 s');
INSERT INTO setting VALUES(62,'machine.software.shared.bandwidth','0 B/s');
INSERT INTO setting VALUES(63,'machine.placement.kind','linear');
INSERT INTO setting VALUES(64,'machine.placement.spread','block');
INSERT INTO setting VALUES(65,'machine.placement.seed','1');
INSERT INTO setting VALUES(66,'machine.placement.list','[]');
INSERT INTO setting VALUES(67,'machine.noise.compute','0 %');
INSERT INTO setting VALUES(68,'machine.noise.background.load','0 %');
INSERT INTO setting VALUES(69,'machine.noise.background.message','1 KiB');
INSERT INTO setting VALUES(70,'model.generator','serial-chain');
INSERT INTO setting VALUES(71,'model.n','2');
INSERT INTO setting VALUES(72,'model.joint','revolute');
INSERT INTO setting VALUES(73,'model.base','fixed');
INSERT INTO setting VALUES(74,'model.inertia','uniform');
INSERT INTO setting VALUES(75,'model.pose','random');
INSERT INTO setting VALUES(76,'model.axes','twisted');
INSERT INTO setting VALUES(77,'model.length','1 m');
INSERT INTO setting VALUES(78,'model.radius','50 mm');
INSERT INTO setting VALUES(79,'model.mass','1 kg');
INSERT INTO setting VALUES(80,'model.mass_ratio','1');
INSERT INTO setting VALUES(81,'model.gravity','[0 m/s^2, 0 m/s^2, -9.81 m/s^2]');
INSERT INTO setting VALUES(82,'model.base_acceleration.angular','[0 rad/s^2, 0 rad/s^2, 0 rad/s^2]');
INSERT INTO setting VALUES(83,'model.base_acceleration.linear','[0 m/s^2, 0 m/s^2, 0 m/s^2]');
INSERT INTO setting VALUES(84,'model.rate','1 rad/s');
INSERT INTO setting VALUES(85,'model.torque','1 N m');
INSERT INTO setting VALUES(86,'model.external_force','0 N');
INSERT INTO setting VALUES(87,'model.stiffness','0 N m/rad');
INSERT INTO setting VALUES(88,'model.damping','0 N m s/rad');
INSERT INTO setting VALUES(89,'model.stabilisation','0 rad/s');
INSERT INTO setting VALUES(90,'model.branch','2');
INSERT INTO setting VALUES(91,'model.seed','1');
INSERT INTO setting VALUES(92,'model.path','');
INSERT INTO setting VALUES(93,'kernel.name','dynamics');
INSERT INTO setting VALUES(94,'kernel.formulation','paper');
INSERT INTO setting VALUES(95,'kernel.solver','pcr-symmetric');
INSERT INTO setting VALUES(96,'kernel.part_solver','pcr');
INSERT INTO setting VALUES(97,'kernel.operators','structured');
INSERT INTO setting VALUES(98,'kernel.algebra','auto');
INSERT INTO setting VALUES(99,'kernel.precision','double');
INSERT INTO setting VALUES(100,'kernel.partition','block');
INSERT INTO setting VALUES(101,'kernel.composites_incoming','false');
INSERT INTO setting VALUES(102,'kernel.hybrid_levels','1');
INSERT INTO setting VALUES(103,'kernel.refinement','as-needed');
INSERT INTO setting VALUES(104,'kernel.residual','working');
INSERT INTO setting VALUES(105,'kernel.inner_refinements','0');
INSERT INTO setting VALUES(106,'kernel.outer_refinements','0');
INSERT INTO setting VALUES(107,'kernel.steps','0');
INSERT INTO setting VALUES(108,'kernel.step_size','1 ms');
INSERT INTO setting VALUES(109,'kernel.step','semi-implicit');
INSERT INTO setting VALUES(110,'kernel.repeat','1');
INSERT INTO setting VALUES(111,'kernel.message','0 B');
INSERT INTO setting VALUES(112,'kernel.distance','1');
INSERT INTO setting VALUES(113,'kernel.algorithm','auto');
INSERT INTO setting VALUES(114,'kernel.root','0');
INSERT INTO setting VALUES(115,'kernel.ring_ranks','0');
INSERT INTO setting VALUES(116,'ranks','3');
INSERT INTO setting VALUES(117,'machine.network.level','auto-tolerance');
INSERT INTO setting VALUES(118,'machine.network.tolerance','3 %');
INSERT INTO setting VALUES(119,'model.n','3');
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
INSERT INTO run_setting VALUES(1,108);
INSERT INTO run_setting VALUES(1,109);
INSERT INTO run_setting VALUES(1,110);
INSERT INTO run_setting VALUES(1,111);
INSERT INTO run_setting VALUES(1,112);
INSERT INTO run_setting VALUES(1,113);
INSERT INTO run_setting VALUES(1,114);
INSERT INTO run_setting VALUES(1,115);
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
INSERT INTO run_setting VALUES(2,66);
INSERT INTO run_setting VALUES(2,67);
INSERT INTO run_setting VALUES(2,68);
INSERT INTO run_setting VALUES(2,69);
INSERT INTO run_setting VALUES(2,70);
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
INSERT INTO run_setting VALUES(2,110);
INSERT INTO run_setting VALUES(2,111);
INSERT INTO run_setting VALUES(2,112);
INSERT INTO run_setting VALUES(2,113);
INSERT INTO run_setting VALUES(2,114);
INSERT INTO run_setting VALUES(2,115);
INSERT INTO run_setting VALUES(2,116);
INSERT INTO run_setting VALUES(2,117);
INSERT INTO run_setting VALUES(2,118);
INSERT INTO run_setting VALUES(2,119);
CREATE TABLE stage (
    run_id            INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    stage             INTEGER NOT NULL,
    name TEXT NOT NULL, -- as the program calls it
    compute_sum_ps INTEGER, -- computing, of all ranks; NULL: does not fit into 64 bits
    compute_min_ps INTEGER NOT NULL, -- computing, least rank
    compute_max_ps INTEGER NOT NULL, -- computing, most loaded rank
    send_sum_ps INTEGER, -- send overhead, copies, back-pressure of the sender's software, of all ranks; NULL: does not fit into 64 bits
    send_min_ps INTEGER NOT NULL, -- send overhead, copies, back-pressure of the sender's software, least rank
    send_max_ps INTEGER NOT NULL, -- send overhead, copies, back-pressure of the sender's software, most loaded rank
    recv_sum_ps INTEGER, -- receive overhead and copies, of all ranks; NULL: does not fit into 64 bits
    recv_min_ps INTEGER NOT NULL, -- receive overhead and copies, least rank
    recv_max_ps INTEGER NOT NULL, -- receive overhead and copies, most loaded rank
    wait_sum_ps INTEGER, -- waiting that an uncontended network would also have caused, and idling at the end, of all ranks; NULL: does not fit into 64 bits
    wait_min_ps INTEGER NOT NULL, -- waiting that an uncontended network would also have caused, and idling at the end, least rank
    wait_max_ps INTEGER NOT NULL, -- waiting that an uncontended network would also have caused, and idling at the end, most loaded rank
    contention_sum_ps INTEGER, -- further waiting for links, ports and servers shared with other messages, of all ranks; NULL: does not fit into 64 bits
    contention_min_ps INTEGER NOT NULL, -- further waiting for links, ports and servers shared with other messages, least rank
    contention_max_ps INTEGER NOT NULL, -- further waiting for links, ports and servers shared with other messages, most loaded rank
    total_sum_ps INTEGER, -- all of these, of all ranks; NULL: does not fit into 64 bits
    total_min_ps INTEGER NOT NULL, -- all of these, least rank
    total_max_ps INTEGER NOT NULL, -- all of these, most loaded rank
    messages INTEGER NOT NULL, -- sent by all ranks
    sent_bytes INTEGER NOT NULL, -- in them
    flops INTEGER NOT NULL, -- additions, subtractions and multiplications
    divisions INTEGER NOT NULL, -- floating-point divisions
    square_roots INTEGER NOT NULL, -- square roots
    sines INTEGER NOT NULL, -- sines and cosines, one each
    copied_bytes INTEGER NOT NULL, -- copied from memory to memory
    calls INTEGER NOT NULL, -- calls of small dense operators
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
INSERT INTO stage VALUES(2,0,'Pre-processing',11327276,2890910,4218183,24047072,6011768,12023536,28047072,7011768,14023536,14000000,0,11000000,0,0,0,77421420,20241719,30265255,4,32,150,0,0,16,0,12);
INSERT INTO stage VALUES(2,1,'NE[1]',7927272,436364,5645454,73270944,12282432,36706080,85270944,28282432,28564864,131662980,3494067,79851198,0,0,0,298132140,70469249,120852426,12,864,414,0,0,0,0,8);
INSERT INTO stage VALUES(2,2,'NE[2]',11663636,2190910,5872726,36423648,0,24282432,42423648,0,28282432,35565224,0,33416606,0,0,0,126076156,30155158,63299038,6,288,603,0,0,0,0,14);
INSERT INTO stage VALUES(2,3,'NE[3]',17590908,4018182,7709090,36423648,0,24282432,42423648,0,28282432,109912858,21218017,49926616,0,0,0,206351062,49518631,85918138,6,288,918,0,0,0,0,18);
INSERT INTO stage VALUES(2,4,'CFA[1]',29736363,4959091,14804545,24047072,6011768,12023536,28047072,7011768,14023536,25139999,0,20672190,0,0,0,106970506,22450436,43668453,4,32,1619,0,0,0,0,6);
INSERT INTO stage VALUES(2,5,'CFA[2]',58631815,18163635,22304545,62706640,18529560,25412160,72706640,21823760,28823760,101828357,23201282,41060012,0,0,0,295873452,96319378,99812327,10,1840,2925,45,0,0,0,40);
INSERT INTO stage VALUES(2,6,'CFA[3]',2109091,600000,909091,12117680,0,6058840,14117680,0,7058840,19305912,0,19305912,0,0,0,47650363,6658840,26964752,2,80,116,0,0,0,0,0);
INSERT INTO stage VALUES(2,7,'end',0,0,0,0,0,0,0,0,0,18583886,0,15798861,0,0,0,18583886,0,15798861,0,0,0,0,0,0,0,0);
CREATE TABLE rank_stage (
    run_id        INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    rank          INTEGER NOT NULL,
    stage         INTEGER NOT NULL,
    compute_ps INTEGER NOT NULL, -- computing
    send_ps INTEGER NOT NULL, -- send overhead, copies, back-pressure of the sender's software
    recv_ps INTEGER NOT NULL, -- receive overhead and copies
    wait_ps INTEGER NOT NULL, -- waiting that an uncontended network would also have caused, and idling at the end
    contention_ps INTEGER NOT NULL, -- further waiting for links, ports and servers shared with other messages
    messages INTEGER NOT NULL, -- sent
    sent_bytes INTEGER NOT NULL, -- in them
    flops INTEGER NOT NULL, -- additions, subtractions and multiplications
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
INSERT INTO rank_stage VALUES(2,0,1,5645454,24282432,28564864,48317715,0,4,192,294);
INSERT INTO rank_stage VALUES(2,0,2,5872726,24282432,0,0,0,4,192,301);
INSERT INTO rank_stage VALUES(2,0,3,7709090,0,28282432,49926616,0,0,0,402);
INSERT INTO rank_stage VALUES(2,0,4,4959091,6011768,7011768,4467809,0,1,8,270);
INSERT INTO rank_stage VALUES(2,0,5,18163635,18529560,22059120,41060012,0,3,360,900);
INSERT INTO rank_stage VALUES(2,0,6,600000,0,7058840,19305912,0,0,0,33);
INSERT INTO rank_stage VALUES(2,1,0,4218183,12023536,14023536,0,0,2,16,56);
INSERT INTO rank_stage VALUES(2,1,1,1845454,36706080,28423648,3494067,0,6,480,96);
INSERT INTO rank_stage VALUES(2,1,2,3600000,12141216,14141216,33416606,0,2,96,187);
INSERT INTO rank_stage VALUES(2,1,3,5863636,12141216,14141216,38768225,0,2,96,306);
INSERT INTO rank_stage VALUES(2,1,4,14804545,12023536,14023536,0,0,2,16,806);
INSERT INTO rank_stage VALUES(2,1,5,22304545,25412160,28823760,23201282,0,4,960,1125);
INSERT INTO rank_stage VALUES(2,1,6,909091,6058840,7058840,0,0,1,40,50);
INSERT INTO rank_stage VALUES(2,1,7,0,0,0,2785025,0,0,0,0);
INSERT INTO rank_stage VALUES(2,2,0,2890910,6011768,7011768,11000000,0,1,8,38);
INSERT INTO rank_stage VALUES(2,2,1,436364,12282432,28282432,79851198,0,2,192,24);
INSERT INTO rank_stage VALUES(2,2,2,2190910,0,28282432,2148618,0,0,0,115);
INSERT INTO rank_stage VALUES(2,2,3,4018182,24282432,0,21218017,0,4,192,210);
INSERT INTO rank_stage VALUES(2,2,4,9972727,6011768,7011768,20672190,0,1,8,543);
INSERT INTO rank_stage VALUES(2,2,5,18163635,18764920,21823760,37567063,0,3,520,900);
INSERT INTO rank_stage VALUES(2,2,6,600000,6058840,0,0,0,1,40,33);
INSERT INTO rank_stage VALUES(2,2,7,0,0,0,15798861,0,0,0,0);
CREATE TABLE baseline (
    run_id       INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    ordinal      INTEGER NOT NULL,
    name TEXT NOT NULL, -- of the serial code
    time_ps INTEGER NOT NULL, -- predicted, on one processor
    flops INTEGER NOT NULL, -- additions, subtractions and multiplications
    divisions INTEGER NOT NULL, -- floating-point divisions
    square_roots INTEGER NOT NULL, -- square roots
    sines INTEGER NOT NULL, -- sines and cosines, one each
    copied_bytes INTEGER NOT NULL, -- copied from memory to memory
    calls INTEGER NOT NULL, -- calls of small dense operators
    PRIMARY KEY (run_id, ordinal)
) STRICT, WITHOUT ROWID;
INSERT INTO baseline VALUES(1,0,'parallel code on one processor',61701515,2905,20,0,10,0,47);
INSERT INTO baseline VALUES(1,1,'rnea',9190909,390,0,0,4,0,2);
INSERT INTO baseline VALUES(1,2,'rnea+aba',28516970,1329,2,0,8,0,4);
INSERT INTO baseline VALUES(1,3,'rnea+crba',26977273,1085,5,2,12,0,6);
INSERT INTO baseline VALUES(1,4,'rnea+cfa-paper',50698485,2496,10,0,8,0,11);
INSERT INTO baseline VALUES(1,5,'rnea+cfa-direct',48780303,2396,10,0,8,0,9);
INSERT INTO baseline VALUES(1,6,'fastest serial',26977273,1085,5,2,12,0,6);
INSERT INTO baseline VALUES(2,0,'parallel code on one processor',138986364,6745,45,0,16,0,98);
INSERT INTO baseline VALUES(2,1,'rnea',14222727,609,0,0,6,0,3);
INSERT INTO baseline VALUES(2,2,'rnea+aba',46348182,2190,3,0,12,0,6);
INSERT INTO baseline VALUES(2,3,'rnea+crba',44062727,1819,9,3,18,0,9);
INSERT INTO baseline VALUES(2,4,'rnea+cfa-paper',84090909,4185,15,0,12,0,17);
INSERT INTO baseline VALUES(2,5,'rnea+cfa-direct',81213636,4035,15,0,12,0,14);
INSERT INTO baseline VALUES(2,6,'fastest serial',44062727,1819,9,3,18,0,9);
CREATE TABLE error_check (
    run_id         INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    ordinal        INTEGER NOT NULL,
    quantity TEXT NOT NULL, -- what was compared: tau, qdd
    reference TEXT NOT NULL, -- with which algorithm's
    relative_error REAL, -- largest difference over the largest reference; NULL: not finite
    tolerance REAL, -- above it the run is invalid
    passed INTEGER NOT NULL, -- 1: within the tolerance
    CHECK (passed IN (0, 1)),
    PRIMARY KEY (run_id, ordinal)
) STRICT, WITHOUT ROWID;
INSERT INTO error_check VALUES(1,0,'tau','rnea',0.0,9.9999999999999993945e-12,1);
INSERT INTO error_check VALUES(1,1,'qdd','aba',9.0587512519802748664e-15,1.0000000000000000209e-08,1);
INSERT INTO error_check VALUES(2,0,'tau','rnea',2.0850764942258289587e-16,9.9999999999999993945e-12,1);
INSERT INTO error_check VALUES(2,1,'qdd','aba',5.7144936995522675748e-14,1.0000000000000000209e-08,1);
CREATE TABLE link_load (
    run_id      INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    link        INTEGER NOT NULL,
    from_router INTEGER, -- NULL: injection of `node`
    to_router INTEGER, -- NULL: ejection to `node`
    node INTEGER, -- of an injection or ejection; NULL: between routers
    messages INTEGER NOT NULL, -- that went over it
    sent_bytes INTEGER NOT NULL, -- in them
    busy_ps INTEGER NOT NULL, -- time in use
    queue_ps INTEGER NOT NULL, -- sum over the messages of the time spent waiting for it
    PRIMARY KEY (run_id, link)
) STRICT, WITHOUT ROWID;
CREATE TABLE span (
    run_id   INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    span     INTEGER NOT NULL,
    rank INTEGER NOT NULL, -- whose timeline
    stage INTEGER NOT NULL, -- number of the stage
    kind TEXT NOT NULL CHECK (kind IN ('compute', 'send', 'recv', 'wait', 'barrier')), -- what the rank did
    begin_ps INTEGER NOT NULL, -- simulated time
    end_ps INTEGER NOT NULL, -- simulated time
    peer INTEGER, -- the other rank; NULL: none
    bytes INTEGER NOT NULL, -- of the message
    message INTEGER, -- pairs a send with its receive; NULL: none
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
    at             TEXT NOT NULL,      -- where: "P=128", "4096 B"
    unit           TEXT NOT NULL,
    reference      REAL,
    value          REAL,
    relative_error REAL,
    tolerance      REAL,
    class          TEXT NOT NULL,      -- evidence: exact, P, PR, D, E, blind
    verdict        TEXT NOT NULL CHECK (verdict IN ('pass', 'fail', 'explained', 'not-testable')),
    source         TEXT NOT NULL,
    cause          TEXT NOT NULL DEFAULT '', -- of an error that is explained, of a point that cannot be tested
    UNIQUE (suite, subject, quantity, at)
) STRICT;
CREATE TABLE claim (
    id         TEXT NOT NULL,
    variant    TEXT NOT NULL,
    statement  TEXT NOT NULL,
    test       TEXT NOT NULL,          -- formula over this database
    unit       TEXT NOT NULL,
    value      REAL,
    threshold  REAL,
    value_low  REAL,                   -- range over the samples
    value_high REAL,
    samples    INTEGER NOT NULL DEFAULT 0,
    share      REAL,
    verdict    TEXT NOT NULL CHECK (verdict IN ('pass', 'fail', 'not-testable')),
    judged     TEXT NOT NULL DEFAULT '', -- of variant '': which row is judged, with which tolerance, and why
    testable   INTEGER,                -- of variant '': how many variants can be judged, and in how many it holds
    holding    INTEGER,
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
    at             TEXT NOT NULL,      -- point of the scenario: "n=P=128"
    family         TEXT NOT NULL,      -- SHA-256 of the settings without sizes, level and seeds: what it holds for
    method         TEXT NOT NULL,      -- a curve
    rung           TEXT NOT NULL,      -- a point on it: level, step size, tolerance
    ordinal        INTEGER NOT NULL,
    quantity       TEXT NOT NULL,
    reference      TEXT NOT NULL,
    relative_error REAL,               -- NULL: failed, or not finite
    host_s         REAL,
    machine_ps     INTEGER,            -- predicted time on the machine
    status         TEXT NOT NULL CHECK (status IN ('ok', 'degraded', 'failed')),
    text           TEXT NOT NULL DEFAULT '',
    PRIMARY KEY (scenario, ladder, family, at, method, rung, quantity)
) STRICT, WITHOUT ROWID;
INSERT INTO ladder VALUES('small','network','n=P=3','1307e29236be256e072521fd606d8dd026170bbed29b7c9c810d105c6b1b12f0','auto','auto',11,'finish times','flit',0.0,0.00010147100056201452389,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','1307e29236be256e072521fd606d8dd026170bbed29b7c9c810d105c6b1b12f0','auto','auto',10,'makespan','flit',0.0,0.00010147100056201452389,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','1307e29236be256e072521fd606d8dd026170bbed29b7c9c810d105c6b1b12f0','closed form','closed form',1,'finish times','flit',0.26681714510679344076,1.3841000509273726493e-05,287666489,'ok','mean work and messages of a rank, no overlap');
INSERT INTO ladder VALUES('small','network','n=P=3','1307e29236be256e072521fd606d8dd026170bbed29b7c9c810d105c6b1b12f0','closed form','closed form',0,'makespan','flit',0.26681714510679344076,1.3841000509273726493e-05,287666489,'ok','mean work and messages of a rank, no overlap');
INSERT INTO ladder VALUES('small','network','n=P=3','1307e29236be256e072521fd606d8dd026170bbed29b7c9c810d105c6b1b12f0','flit','flit',9,'finish times','flit',0.0,0.00024452500019833678379,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','1307e29236be256e072521fd606d8dd026170bbed29b7c9c810d105c6b1b12f0','flit','flit',8,'makespan','flit',0.0,0.00024452500019833678379,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','1307e29236be256e072521fd606d8dd026170bbed29b7c9c810d105c6b1b12f0','link','link',5,'finish times','flit',0.0,7.679499958612723276e-05,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','1307e29236be256e072521fd606d8dd026170bbed29b7c9c810d105c6b1b12f0','link','link',4,'makespan','flit',0.0,7.679499958612723276e-05,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','1307e29236be256e072521fd606d8dd026170bbed29b7c9c810d105c6b1b12f0','loggp','loggp',3,'finish times','flit',0.0,7.2488999649067409336e-05,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','1307e29236be256e072521fd606d8dd026170bbed29b7c9c810d105c6b1b12f0','loggp','loggp',2,'makespan','flit',0.0,7.2488999649067409336e-05,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','1307e29236be256e072521fd606d8dd026170bbed29b7c9c810d105c6b1b12f0','packet','packet',7,'finish times','flit',0.0,0.00011428000016167061403,392352995,'ok','');
INSERT INTO ladder VALUES('small','network','n=P=3','1307e29236be256e072521fd606d8dd026170bbed29b7c9c810d105c6b1b12f0','packet','packet',6,'makespan','flit',0.0,0.00011428000016167061403,392352995,'ok','');
CREATE TABLE ladder_choice (
    scenario       TEXT NOT NULL,
    ladder         TEXT NOT NULL,
    at             TEXT NOT NULL,
    quantity       TEXT NOT NULL,
    tolerance      REAL NOT NULL,
    method         TEXT,               -- NULL: no rung is within the tolerance
    rung           TEXT,
    relative_error REAL,
    cost_ratio     REAL,               -- of the finest rung's cost to this one's
    PRIMARY KEY (scenario, ladder, at, quantity, tolerance)
) STRICT, WITHOUT ROWID;
CREATE TABLE stability (
    suite          TEXT NOT NULL,
    subject        TEXT NOT NULL,      -- the case
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
    step_s         REAL,               -- largest stable step, of integrators
    reason         TEXT NOT NULL,
    PRIMARY KEY (suite, subject, algorithm, precision)
) STRICT, WITHOUT ROWID;
CREATE TABLE run_omission (
    run_id INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    what TEXT NOT NULL, -- was not computed
    why TEXT NOT NULL, -- why no result needs it
    class TEXT NOT NULL CHECK (class IN ('exact', 'bounded')), -- exact: the results are the same numbers; bounded: to within `bound`
    bound REAL, -- largest relative change of a result, of bounded ones
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
INSERT INTO run_omission VALUES(2,'external forces','no body has any','exact',NULL);
INSERT INTO run_omission VALUES(2,'general joints in the serial references','all joints are revolute','exact',NULL);
INSERT INTO run_omission VALUES(2,'scene and serial answers of other runs','runs of one scene share them','exact',NULL);
INSERT INTO run_omission VALUES(2,'timeline','record.spans does not ask for it','exact',NULL);
CREATE TABLE omission (
    scenario         TEXT NOT NULL,
    what             TEXT NOT NULL,
    ordinal          INTEGER NOT NULL,
    why              TEXT NOT NULL,
    class            TEXT NOT NULL CHECK (class IN ('exact', 'bounded')),
    bound            REAL,             -- relative, of bounded ones
    at               TEXT NOT NULL,    -- point of the scenario that was measured: "n=P=128"
    host_s           REAL,             -- of the run without it; NULL here and below: nothing brings it back
    host_saved_s     REAL,
    host_noise_s     REAL,             -- savings below it cannot be told from nothing
    machine_ps       INTEGER,
    machine_saved_ps INTEGER,
    PRIMARY KEY (scenario, what)
) STRICT, WITHOUT ROWID;
CREATE TABLE explain_point (
    id        INTEGER PRIMARY KEY,
    subject   TEXT NOT NULL,           -- claim, or 'together'
    key       TEXT NOT NULL,           -- fingerprint of operators and settings
    operators TEXT NOT NULL,
    settings  TEXT NOT NULL,           -- what differs from the machine's file, as for --set; '' is the file itself
    distance  REAL NOT NULL,           -- sum of |ln(value / nominal)|
    published INTEGER NOT NULL,        -- 1: every change is within a published range
    runs      TEXT NOT NULL,           -- first 12 digits of the config_hash of each run
    UNIQUE (subject, key)
) STRICT;
CREATE TABLE explain_judged (
    point_id INTEGER NOT NULL REFERENCES explain_point (id) ON DELETE CASCADE,
    claim    TEXT NOT NULL,
    variant  TEXT NOT NULL,
    value    REAL,
    margin   REAL,                     -- from holding (< 0) or from failing (> 0)
    holds    INTEGER CHECK (holds IN (0, 1)),
    PRIMARY KEY (point_id, claim, variant)
) STRICT, WITHOUT ROWID;
CREATE TABLE explain_map (
    subject  TEXT NOT NULL,
    i        INTEGER NOT NULL,
    j        INTEGER NOT NULL,
    x_key    TEXT NOT NULL,
    y_key    TEXT NOT NULL,
    x_label  TEXT NOT NULL,
    y_label  TEXT NOT NULL,
    x        REAL NOT NULL,            -- value over nominal; of shares the share; so are all that follow
    y        REAL NOT NULL,
    x_low    REAL, x_high REAL,        -- published range, NULL: none
    y_low    REAL, y_high REAL,
    x_nominal REAL NOT NULL, y_nominal REAL NOT NULL,
    x_answer REAL NOT NULL, y_answer REAL NOT NULL,
    variant  TEXT NOT NULL,
    point_id INTEGER NOT NULL REFERENCES explain_point (id) ON DELETE CASCADE,
    PRIMARY KEY (subject, i, j)
) STRICT, WITHOUT ROWID;
CREATE TABLE explain_answer (
    subject   TEXT NOT NULL,
    goal      TEXT NOT NULL,           -- 'own': the claim's own variant; 'any': any operators and serial baseline
    verdict   TEXT NOT NULL CHECK (verdict IN ('holds', 'not found', 'never')),
    variant   TEXT NOT NULL,
    operators TEXT NOT NULL,
    settings  TEXT NOT NULL,           -- of the smallest change that was found, or of the point nearest to holding
    distance  REAL,                    -- each other choice counted as a factor of 2
    value     REAL,
    margin    REAL,
    points    INTEGER NOT NULL,        -- that were tried for the subject
    confirmed INTEGER,                 -- 1: the study's own runs at that point say so, too; NULL: nothing to confirm
    study     INTEGER,                 -- how many they are
    sentence  TEXT NOT NULL,
    PRIMARY KEY (subject, goal)
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
CREATE VIEW v_machine_state AS
WITH newest AS (
    SELECT machine, machine_hash FROM run WHERE id IN (SELECT max(id) FROM run WHERE machine_hash IS NOT NULL GROUP BY machine))
SELECT r.id AS run_id, r.machine, r.machine_changes,
       CASE WHEN r.machine_changes IS NULL THEN 'own' WHEN r.machine_hash <> w.machine_hash THEN 'older'
            WHEN r.machine_changes = '{}' THEN 'as shipped' ELSE 'changed' END AS state
FROM run r LEFT JOIN newest w ON w.machine = r.machine;
CREATE VIEW v_shown AS
WITH state AS (
    SELECT s.run_id, r.machine, r.kernel, s.state = 'as shipped' AS shipped
    FROM v_machine_state s JOIN run r ON r.id = s.run_id WHERE r.status = 'ok'),
most AS (SELECT machine, kernel, max(shipped) AS shipped FROM state GROUP BY machine, kernel)
SELECT a.run_id FROM state a JOIN most b ON b.machine = a.machine AND b.kernel = a.kernel AND b.shipped = a.shipped;
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
SELECT id, variant, statement, verdict, value, unit, threshold, value_low, value_high, share, samples, testable, holding,
       judged, note
FROM claim;
CREATE VIEW v_provenance AS
SELECT r.id AS run_id, r.scenario, r.config_hash, r.seed, r.rep, r.digest, r.status, r.created_utc, b.version, b.git,
       b.compiler, b.flags, r.host_s, r.host_total_s, r.host_peak_bytes, r.left_out
FROM run r JOIN build b ON b.id = r.build_id;
COMMIT;
PRAGMA application_id = 1835625828;
PRAGMA user_version = 5;
