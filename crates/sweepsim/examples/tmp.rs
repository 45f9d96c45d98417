use sweepsim::*; use sweepsim_dexel::Grid; use sweepsim_motion::*; use sweepsim_spline::*;
fn main(){
 let grid=Grid::new([-4.37;2],[4.37;2],[9,9]).unwrap();
 let which=std::env::args().nth(1).unwrap();
 let tool = match which.as_str(){"flat"=>Tool::flat(2.0,6.0).unwrap(),"bull"=>Tool::bull(2.0,0.6,7.0).unwrap(),_=>Tool::ball(2.0,8.0).unwrap()};
 let k=|d:usize|KnotVector::new(d,[vec![0.0;d+1],vec![1.0;d+1]].concat()).unwrap();
 let half=0.35f64;
 let turn=BSpline::new(vec![k(1)],4,vec![1.0,0.0,0.0,0.0,half.cos(),0.6*half.sin(),0.0,0.8*half.sin()]).unwrap();
 let tip=RationalSpline::new(vec![k(1)],3,&[-2.0,-1.0,0.0,2.0,1.0,1.0],&[1.0;2]).unwrap();
 let m=SplineMotion::from_quaternions(&turn,&tip).unwrap();
 let (s,_)=m.segments().next().unwrap();
 let weights=s.weights().to_vec(); let pts:Vec<f64>=s.turns().iter().zip(&weights).flat_map(|(t,w)|(t.transpose()/ *w).as_slice().to_vec()).collect();
 let mm=SplineMotion::from_matrices(&RationalSpline::new(vec![k(2)],9,&pts,&weights).unwrap(),&tip,1e-12).unwrap();
 let UP=[0.0,0.0,1.0];
 let p=|t:[f64;3],a:[f64;3]|Pose::new(t,a).unwrap();
 let arcp=|f:Pose,t:Pose,c:[f64;3],n:[f64;3],tu:i32| Path::with_moves(vec![f,t],vec![Move::arc(TipArc::between(f.tip().into(),t.tip().into(),c,n,tu).unwrap())]).unwrap();
 let rot=|t:RotaryTable,pl:&[([f64;3],[f64;2])]| Path::with_moves(pl.iter().map(|(a,b)|p(*a,t.axis(*b))).collect(),pl.windows(2).map(|w|Move::straight(Turning::Rotary{table:t,from:w[0].1,to:w[1].1})).collect()).unwrap();
 let o=[0.0;3];
 if false {println!("turns {:?}\nw {:?}\ntwist {:?}\nrate {:?}\n{:?}", s.turns(), s.weights(), s.twist(), s.turn_rate(), s.tip_rate());}
 let whole=|q:[f64;4],tip:[f64;3]|{ let t=nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q[0],q[1],q[2],q[3])).to_rotation_matrix(); Pose::with_side(tip,t.matrix().column(2).into(),t.matrix().column(0).into()).unwrap()};
 let sl=Path::new(vec![whole([1.0,0.0,0.0,0.0],[-2.0,-1.0,0.0]),whole([half.cos(),0.6*half.sin(),0.0,0.8*half.sin()],[2.0,1.0,1.0])]).unwrap();
 for (n,path) in [("slerp",sl),("spline",Path::along(m.clone())),("matrix",Path::along(mm)),
 ("even",Path::with_law(vec![p([-3.0,-1.0,0.0],[0.0,0.5,1.0]),p([3.0,1.5,1.0],[0.0,-0.5,1.0])],Law::ConstantSpeed).unwrap()),
 ("rotary",rot(RotaryTable::Ac,&[([-2.0,0.0,0.0],[20.0,-40.0]),([2.0,1.0,0.5],[35.0,50.0])])),
 ("tilt",rot(RotaryTable::Ac,&[([-2.0,0.0,0.0],[-30.0,25.0]),([2.0,1.0,0.5],[40.0,25.0])])),
 ("whole",rot(RotaryTable::Ac,&[([-1.0,0.0,0.0],[30.0,0.0]),([1.0,0.0,0.0],[30.0,360.0])])),
 ("inplace",rot(RotaryTable::Bc,&[(o,[35.0,0.0]),(o,[35.0,-200.0])])),
 ("own",rot(RotaryTable::Ac,&[(o,[0.0,0.0]),([1.0,0.0,0.2],[0.0,90.0])])),
 ("almost",rot(RotaryTable::Ac,&[([-2.0,0.0,0.0],[20.0,10.0]),([2.0,1.0,0.5],[20.0+1e-7,10.0-1e-6])])),
 ("quarter",arcp(p([1.7,0.0,0.0],UP),p([0.0,1.7,0.0],UP),o,UP,1)),
 ("full",arcp(p([1.7,0.0,0.0],UP),p([1.7,0.0,0.0],UP),o,UP,1)),
 ("small",arcp(p([0.5,0.0,0.0],UP),p([0.5,0.0,0.0],UP),o,UP,-1)),
 ("helix",arcp(p([1.5,0.0,0.0],UP),p([-1.5,0.0,1.0],UP),o,UP,2)),
 ("upright",arcp(p([-2.0,0.0,0.0],[0.2,0.2,1.0]),p([2.0,0.0,0.0],[0.2,0.2,1.0]),o,[0.0,1.0,0.0],1)),
 ("arcturn",arcp(p([1.5,0.0,0.0],[0.2,0.2,1.0]),p([0.0,1.5,0.0],[0.2,0.5,1.0]),o,UP,1)),
 ("helixturn",arcp(p([1.5,0.0,0.0],[0.2,0.2,1.0]),p([0.0,1.5,0.8],[0.2,0.5,1.0]),o,UP,-1)),
 ("spiral",arcp(p([1.7,0.0,0.0],UP),p([-1.6988,0.0,0.0],UP),o,UP,1)),
 ("swallow",arcp(p([-1.0,0.0,0.0],[-0.8,0.0,1.0]),p([1.0,0.0,0.0],[0.8,0.0,1.0]),[0.0,0.0,6.0],[0.0,-1.0,0.0],1)),
 ].into_iter().filter(|x|std::env::args().nth(2).is_none_or(|n|n==x.0)){
   let np:usize=(0..path.moves()).map(|k|path.segments(k,true,10.0,5e-8).len()).sum(); print!("{np} parts "); use std::io::Write; std::io::stdout().flush().unwrap();
   let t=std::time::Instant::now();
   let r=sweep(&tool,&path,&grid,&Options::new(1e-6),&()).unwrap();
   println!("{n} {:?} boxes {} charts {} crossings {} repaired {} unresolved {} vol {}",t.elapsed(),r.statistics.boxes,r.statistics.charts,r.statistics.crossings,r.statistics.repaired,r.statistics.unresolved.len(),r.volume.volume());
 }
}
