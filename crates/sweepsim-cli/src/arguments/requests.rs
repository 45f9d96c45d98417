//! From the command line to requests.

use super::{
    CompareOptions, ConvertOptions, DialectOptions, Directions, GridOptions, Output, ProgramOptions, RunOptions,
    SectionOptions, ViewOptions, WritingOptions,
};
use std::path::Path;
use sweepsim_job as job;
use sweepsim_job::{CompareRequest, ConvertRequest, Request, Task};

impl RunOptions {
    /// What is to be done, but for where and how the process does it.
    pub fn request(&self, job: &Path, task: Task) -> Request {
        let mut sweeping = job::SweepOptions::default();
        (sweeping.method, sweeping.boundary, sweeping.tile) = (self.method, self.boundary, self.tile);
        Request::from_file(job)
            .task(task)
            .program(self.program.given())
            .outputs(self.only.iter().map(|output| output.named()))
            .sweeping(sweeping)
            .cells(self.cells)
            .tolerance(self.tolerance)
            .directions(self.directions.map(Directions::named))
            .decimate(self.decimate)
            .frames(self.frames, !self.no_tool)
            .moments(self.moments)
            .view(self.view.given())
    }
}

impl SectionOptions {
    pub fn request(&self) -> Request {
        Request::from_file(&self.job)
            .task(Task::Section)
            .program(self.program.given())
            .tolerance(self.tolerance)
    }
}

impl CompareOptions {
    pub fn request(&self) -> CompareRequest {
        let mut request = CompareRequest::new(&self.part, &self.target);
        request.tolerance = self.tolerance;
        request.limits.clone_from(&self.limits);
        request.align.clone_from(&self.align);
        request.range = self.range;
        request.grid = self.grid.given();
        request.view = self.view.given();
        request
    }
}

impl ConvertOptions {
    pub fn request(&self) -> ConvertRequest {
        let mut request = ConvertRequest::new(&self.input, &self.output);
        request.dialect = self.dialect.given();
        request.writing = self.writing.given();
        request.grid = self.grid.given();
        request.view = self.view.given();
        request.decimate = self.decimate;
        request
    }
}

impl DialectOptions {
    pub fn given(&self) -> job::DialectOptions {
        let mut options = job::DialectOptions::default();
        options.controller.clone_from(&self.controller);
        options.machine.clone_from(&self.machine);
        options.format.clone_from(&self.format);
        (options.lenient, options.strict) = (self.lenient, self.strict);
        options.diameters = self.diameters.iter().copied().collect();
        options.offsets = self.offset.iter().cloned().collect();
        options
    }
}

impl ProgramOptions {
    pub fn given(&self) -> job::ProgramOptions {
        let mut options = job::ProgramOptions::default();
        options.tools.clone_from(&self.tools);
        options.stock.clone_from(&self.stock);
        options.target.clone_from(&self.target);
        options.dialect = self.dialect.given();
        options
    }
}

impl WritingOptions {
    fn given(&self) -> job::WritingOptions {
        let mut options = job::WritingOptions::default();
        options.dialect.clone_from(&self.dialect);
        options.machine.clone_from(&self.for_machine);
        (options.axes, options.decimals) = (self.axes, self.decimals);
        options
    }
}

impl GridOptions {
    fn given(&self) -> job::GridOptions {
        let mut options = job::GridOptions::default();
        options.grid.clone_from(&self.grid);
        (options.area, options.cells) = (self.area, self.cells);
        options
    }
}

impl ViewOptions {
    fn given(&self) -> job::ViewOptions {
        let mut options = job::ViewOptions::default();
        options.camera = [self.camera.azimuth, self.camera.elevation];
        options.orthographic = self.camera.orthographic;
        let planes = self.section.iter();
        options.sections = planes.map(|plane| (plane.axis.index() as u8, plane.at)).collect();
        (options.size, options.axes) = (self.size, !self.no_axes);
        options
    }
}

impl Output {
    fn named(self) -> job::Output {
        match self {
            Self::Dexels => job::Output::Dexels,
            Self::Mesh => job::Output::Mesh,
            Self::Picture => job::Output::Picture,
            Self::Report => job::Output::Report,
            Self::Binary => job::Output::Binary,
            Self::Tridexels => job::Output::Tridexels,
            Self::Step => job::Output::Step,
            Self::Certificate => job::Output::Certificate,
        }
    }
}

impl Directions {
    fn named(self) -> job::Directions {
        match self {
            Self::Xyz => job::Directions::Xyz,
            Self::Z => job::Directions::Z,
        }
    }
}
