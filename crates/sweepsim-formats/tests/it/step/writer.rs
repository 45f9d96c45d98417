//! Small STEP files, written entity by entity.

use std::fmt::Write as _;

/// The text of a STEP file.
pub struct Writer {
    data: String,
    next: usize,
    /// Decimals of numbers are points of this many millimetres: 1 or 25.4.
    pub context: usize,
}

/// An edge of a face: its entity, and whether it is walked along its own direction.
pub type Use = (usize, bool);

impl Writer {
    /// A file in millimetres or inches.
    pub fn new(inches: bool) -> Self {
        let mut file = Self {
            data: String::new(),
            next: 1,
            context: 0,
        };
        let metre = file.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
        let length = if inches {
            let size = file.add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)");
            let measure = file.add(&format!("LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#{metre})"));
            file.add(&format!(
                "(CONVERSION_BASED_UNIT('INCH',#{measure})LENGTH_UNIT()NAMED_UNIT(#{size}))"
            ))
        } else {
            metre
        };
        let angle = file.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
        file.context = file.add(&format!(
            "(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#{length},#{angle}))REPRESENTATION_CONTEXT('',''))"
        ));
        file
    }

    /// Adds an entity; returns its number.
    pub fn add(&mut self, entity: &str) -> usize {
        let number = self.next;
        self.next += 1;
        writeln!(self.data, "#{number}={entity};").unwrap();
        number
    }

    pub fn point(&mut self, [x, y, z]: [f64; 3]) -> usize {
        self.add(&format!("CARTESIAN_POINT('',({x:?},{y:?},{z:?}))"))
    }

    fn direction(&mut self, [x, y, z]: [f64; 3]) -> usize {
        self.add(&format!("DIRECTION('',({x:?},{y:?},{z:?}))"))
    }

    pub fn placement(&mut self, origin: [f64; 3], z: [f64; 3], x: [f64; 3]) -> usize {
        let (origin, z, x) = (self.point(origin), self.direction(z), self.direction(x));
        self.add(&format!("AXIS2_PLACEMENT_3D('',#{origin},#{z},#{x})"))
    }

    pub fn vertex(&mut self, at: [f64; 3]) -> usize {
        let point = self.point(at);
        self.add(&format!("VERTEX_POINT('',#{point})"))
    }

    /// A straight edge.
    pub fn line(&mut self, ends: [usize; 2], places: [[f64; 3]; 2]) -> usize {
        let [from, to] = places;
        let point = self.point(from);
        let direction = self.direction([0, 1, 2].map(|k| to[k] - from[k]));
        let vector = self.add(&format!("VECTOR('',#{direction},1.)"));
        let line = self.add(&format!("LINE('',#{point},#{vector})"));
        self.add(&format!("EDGE_CURVE('',#{},#{},#{line},.T.)", ends[0], ends[1]))
    }

    /// A whole circle about z.
    pub fn circle(&mut self, vertex: usize, centre: [f64; 3], radius: f64) -> usize {
        let placement = self.placement(centre, [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
        let circle = self.add(&format!("CIRCLE('',#{placement},{radius:?})"));
        self.add(&format!("EDGE_CURVE('',#{vertex},#{vertex},#{circle},.T.)"))
    }

    /// A face of a surface; the first loop is its outline.
    pub fn face(&mut self, name: &str, surface: usize, loops: &[Vec<Use>]) -> usize {
        let mut bounds = Vec::new();
        for (number, edges) in loops.iter().enumerate() {
            let uses: Vec<String> = edges
                .iter()
                .map(|(edge, along)| {
                    let along = if *along { ".T." } else { ".F." };
                    format!("#{}", self.add(&format!("ORIENTED_EDGE('',*,*,#{edge},{along})")))
                })
                .collect();
            let way = self.add(&format!("EDGE_LOOP('',({}))", uses.join(",")));
            let kind = if number == 0 { "FACE_OUTER_BOUND" } else { "FACE_BOUND" };
            bounds.push(format!("#{}", self.add(&format!("{kind}('',#{way},.T.)"))));
        }
        self.add(&format!(
            "ADVANCED_FACE('{name}',({}),#{surface},.T.)",
            bounds.join(",")
        ))
    }

    /// Turns a face against its surface, which is the last that was added.
    pub fn reversed(&mut self, face: usize) -> usize {
        let end = self.data.rfind(".T.);").unwrap();
        self.data.replace_range(end..end + 3, ".F.");
        face
    }

    pub fn plane(&mut self, origin: [f64; 3], normal: [f64; 3], x: [f64; 3]) -> usize {
        let placement = self.placement(origin, normal, x);
        self.add(&format!("PLANE('',#{placement})"))
    }

    /// The six faces of a block, outwards: −x, +x, −y, +y, −z, +z.
    pub fn block_faces(&mut self, min: [f64; 3], max: [f64; 3]) -> Vec<usize> {
        let place = |corner: usize| [0, 1, 2].map(|k| if corner >> k & 1 == 1 { max[k] } else { min[k] });
        let vertices: Vec<usize> = (0..8).map(|corner| self.vertex(place(corner))).collect();
        let mut edges = Vec::new();
        for from in 0..8 {
            for k in (0..3).filter(|k| from >> k & 1 == 0) {
                let to = from | 1 << k;
                let ends = [vertices[from], vertices[to]];
                edges.push(([from, to], self.line(ends, [place(from), place(to)])));
            }
        }
        let mut faces = Vec::new();
        for axis in 0..3 {
            let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
            for side in 0..2 {
                let first = side << axis;
                let mut ring = [first, first | u, first | u | v, first | v];
                if side == 0 {
                    ring.reverse();
                }
                let uses = (0..4).map(|k| {
                    let (a, b) = (ring[k], ring[(k + 1) % 4]);
                    let found = edges.iter().find(|(ends, _)| *ends == [a.min(b), a.max(b)]).unwrap();
                    (found.1, a < b)
                });
                let uses = uses.collect();
                let (mut normal, mut x) = ([0.0; 3], [0.0; 3]);
                normal[axis] = if side == 1 { 1.0 } else { -1.0 };
                x[(axis + 1) % 3] = 1.0;
                let plane = self.plane(place(first), normal, x);
                faces.push(self.face(
                    ["left", "right", "front", "back", "bottom", "top"][2 * axis + side],
                    plane,
                    &[uses],
                ));
            }
        }
        faces
    }

    /// The three faces of an upright cylinder: side, bottom, top.
    pub fn cylinder_faces(&mut self, base: [f64; 3], radius: f64, height: f64) -> Vec<usize> {
        let above = [base[0], base[1], base[2] + height];
        let ends = [base, above].map(|centre| [centre[0] + radius, centre[1], centre[2]]);
        let vertices = ends.map(|end| self.vertex(end));
        let [low, high] = [(0, base), (1, above)].map(|(k, centre)| self.circle(vertices[k], centre, radius));
        let seam = self.line(vertices, ends);
        let placement = self.placement(base, [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
        let surface = self.add(&format!("CYLINDRICAL_SURFACE('',#{placement},{radius:?})"));
        let side = self.face(
            "side",
            surface,
            &[vec![(low, true), (seam, true), (high, false), (seam, false)]],
        );
        let under = self.plane(base, [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]);
        let under = self.face("", under, &[vec![(low, false)]]);
        let over = self.plane(above, [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
        vec![side, under, self.face("", over, &[vec![(high, true)]])]
    }

    /// A list of entities.
    pub fn list(numbers: &[usize]) -> String {
        let each: Vec<String> = numbers.iter().map(|number| format!("#{number}")).collect();
        each.join(",")
    }

    pub fn shell(&mut self, closed: bool, faces: &[usize]) -> usize {
        let kind = if closed { "CLOSED_SHELL" } else { "OPEN_SHELL" };
        self.add(&format!("{kind}('',({}))", Self::list(faces)))
    }

    pub fn solid(&mut self, name: &str, faces: &[usize]) -> usize {
        let shell = self.shell(true, faces);
        self.add(&format!("MANIFOLD_SOLID_BREP('{name}',#{shell})"))
    }

    /// A product of these items; returns its definition and its representation.
    pub fn product(&mut self, name: &str, items: &[usize]) -> [usize; 2] {
        let product = self.add(&format!("PRODUCT('{name}','{name}','',())"));
        let formation = self.add(&format!("PRODUCT_DEFINITION_FORMATION('','',#{product})"));
        let definition = self.add(&format!("PRODUCT_DEFINITION('','',#{formation},$)"));
        let shape = self.add(&format!("PRODUCT_DEFINITION_SHAPE('','',#{definition})"));
        let (items, context) = (Self::list(items), self.context);
        let representation = self.add(&format!("SHAPE_REPRESENTATION('',({items}),#{context})"));
        self.add(&format!("SHAPE_DEFINITION_REPRESENTATION(#{shape},#{representation})"));
        [definition, representation]
    }

    /// Places a product in another one: its own origin at a placement.
    pub fn occurrence(&mut self, part: [usize; 2], whole: [usize; 2], to: usize) -> usize {
        let from = self.placement([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
        let occurrence = self.add(&format!(
            "NEXT_ASSEMBLY_USAGE_OCCURRENCE('','','',#{},#{},$)",
            whole[0], part[0]
        ));
        let shape = self.add(&format!("PRODUCT_DEFINITION_SHAPE('','',#{occurrence})"));
        let moved = self.add(&format!("ITEM_DEFINED_TRANSFORMATION('','',#{from},#{to})"));
        let relation = self.add(&format!(
            "(REPRESENTATION_RELATIONSHIP('','',#{},#{})REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#{moved})SHAPE_REPRESENTATION_RELATIONSHIP())",
            part[1], whole[1]
        ));
        self.add(&format!("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#{relation},#{shape})"));
        occurrence
    }

    /// Gives an item a colour.
    pub fn colour(&mut self, item: usize, [r, g, b]: [f64; 3]) {
        let colour = self.add(&format!("COLOUR_RGB('',{r:?},{g:?},{b:?})"));
        let fill = self.add(&format!("FILL_AREA_STYLE_COLOUR('',#{colour})"));
        let area = self.add(&format!("FILL_AREA_STYLE('',(#{fill}))"));
        let surface = self.add(&format!("SURFACE_STYLE_FILL_AREA(#{area})"));
        let side = self.add(&format!("SURFACE_SIDE_STYLE('',(#{surface}))"));
        let usage = self.add(&format!("SURFACE_STYLE_USAGE(.BOTH.,#{side})"));
        let style = self.add(&format!("PRESENTATION_STYLE_ASSIGNMENT((#{usage}))"));
        self.add(&format!("STYLED_ITEM('',(#{style}),#{item})"));
    }

    /// The whole text.
    pub fn text(&self) -> String {
        format!(
            "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n\
             FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n{}ENDSEC;\nEND-ISO-10303-21;\n",
            self.data
        )
    }
}
